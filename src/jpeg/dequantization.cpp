// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/dequantization.inl"
