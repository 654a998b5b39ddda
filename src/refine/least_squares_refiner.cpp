// SPDX-License-Identifier: MIT
#include "freqsynth/refine/least_squares_refiner.inl"
