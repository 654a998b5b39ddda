// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_filter.inl"
