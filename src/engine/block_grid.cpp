#include "freqsynth/engine/block_grid.inl"
