// SPDX-License-Identifier: MIT
#include "freqsynth/refine/literal_refiner.inl"
