#include "freqsynth/basis/dct.inl"
