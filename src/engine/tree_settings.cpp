// SPDX-License-Identifier: MIT
#include "freqsynth/engine/tree_settings.inl"
