// SPDX-License-Identifier: MIT
#include "freqsynth/image/rare_light.inl"
