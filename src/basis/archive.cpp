// SPDX-License-Identifier: MIT
#include "freqsynth/basis/archive.inl"
