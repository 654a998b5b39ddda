#include "freqsynth/image/butterworth.inl"
