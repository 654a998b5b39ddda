// SPDX-License-Identifier: MIT
#include "freqsynth/image/shared_border.inl"
