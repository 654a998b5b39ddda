// SPDX-License-Identifier: MIT
#include "freqsynth/refine/kriging_refiner.inl"
