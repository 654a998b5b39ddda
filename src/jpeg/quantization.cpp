#include "freqsynth/jpeg/quantization.inl"
