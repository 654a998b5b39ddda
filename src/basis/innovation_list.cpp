// SPDX-License-Identifier: MIT
#include "freqsynth/basis/innovation_list.inl"
