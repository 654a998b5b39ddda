#include "freqsynth/basis/kernels.inl"
