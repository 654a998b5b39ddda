// SPDX-License-Identifier: MIT
#include "freqsynth/engine/priority.inl"
