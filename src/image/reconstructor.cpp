#include "freqsynth/image/reconstructor.inl"
