// SPDX-License-Identifier: MIT
#include "freqsynth/image/butterworth.inl"
