// SPDX-License-Identifier: MIT
#include "freqsynth/basis/large_pages.inl"
