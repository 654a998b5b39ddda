// SPDX-License-Identifier: MIT
#include "freqsynth/image/mean_filter.inl"
