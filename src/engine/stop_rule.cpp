// SPDX-License-Identifier: MIT
#include "freqsynth/engine/stop_rule.inl"
