#include "freqsynth/image/frequency_image.inl"
