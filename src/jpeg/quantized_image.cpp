// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/quantized_image.inl"
