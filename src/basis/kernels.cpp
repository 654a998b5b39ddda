// SPDX-License-Identifier: MIT
#include "freqsynth/basis/kernels.inl"
