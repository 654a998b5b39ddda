// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_transform.inl"
