// SPDX-License-Identifier: MIT
#include "freqsynth/image/filter_kernel.inl"
