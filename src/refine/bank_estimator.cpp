// SPDX-License-Identifier: MIT
#include "freqsynth/refine/bank_estimator.inl"
