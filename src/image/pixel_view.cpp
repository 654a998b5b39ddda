// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_view.inl"
