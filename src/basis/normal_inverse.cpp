// SPDX-License-Identifier: MIT
#include "freqsynth/basis/normal_inverse.inl"
