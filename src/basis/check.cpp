#include "freqsynth/basis/check.inl"
