#include "freqsynth/jpeg/block_scaling.inl"
