#include "freqsynth/jpeg/quantization_target.inl"
