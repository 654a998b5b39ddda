#include "freqsynth/basis/inverse_list.inl"
