#include "freqsynth/basis/normal_inverse.inl"
