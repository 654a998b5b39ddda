// SPDX-License-Identifier: MIT
#include "freqsynth/image/block_noise.inl"
