#include "freqsynth/jpeg/quantized_image.inl"
