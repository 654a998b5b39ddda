// SPDX-License-Identifier: MIT
#include "freqsynth/basis/check.inl"
