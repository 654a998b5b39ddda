// SPDX-License-Identifier: MIT
#include "freqsynth/image/frequency_image.inl"
