// SPDX-License-Identifier: MIT
#include "freqsynth/image/block_pixels.inl"
