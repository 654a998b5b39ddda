// SPDX-License-Identifier: MIT
#include "freqsynth/image/axis_weights.inl"
