#include "freqsynth/image/pixel_finisher.inl"
