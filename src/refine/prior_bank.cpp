// SPDX-License-Identifier: MIT
#include "freqsynth/refine/prior_bank.inl"
