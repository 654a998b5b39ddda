// SPDX-License-Identifier: MIT
#include "freqsynth/basis/dct.inl"
