// SPDX-License-Identifier: MIT
#include "freqsynth/engine/importance_map.inl"
