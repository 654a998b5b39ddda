// SPDX-License-Identifier: MIT
#include "freqsynth/basis/innovation_store.inl"
