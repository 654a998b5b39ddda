// SPDX-License-Identifier: MIT
#include "freqsynth/basis/node_positions.inl"
