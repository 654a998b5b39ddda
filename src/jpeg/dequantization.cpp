#include "freqsynth/jpeg/dequantization.inl"
