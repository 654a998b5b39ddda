// SPDX-License-Identifier: MIT
#include "freqsynth/basis/inverse_list.inl"
