#include "freqsynth/image/pixel_view.inl"
