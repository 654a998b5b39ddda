// SPDX-License-Identifier: MIT
#include "freqsynth/image/smooth_noise.inl"
