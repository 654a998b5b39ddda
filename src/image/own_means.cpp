// SPDX-License-Identifier: MIT
#include "freqsynth/image/own_means.inl"
