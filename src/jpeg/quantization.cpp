// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/quantization.inl"
