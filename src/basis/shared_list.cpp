// SPDX-License-Identifier: MIT
#include "freqsynth/basis/shared_list.inl"
