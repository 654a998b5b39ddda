#include "freqsynth/basis/sample_sequence.inl"
