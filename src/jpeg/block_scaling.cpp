// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/block_scaling.inl"
