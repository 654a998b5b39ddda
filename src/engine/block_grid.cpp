// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_grid.inl"
