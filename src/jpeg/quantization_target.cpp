// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/quantization_target.inl"
