#include "freqsynth/basis/shared_list.inl"
