// SPDX-License-Identifier: MIT
#include "freqsynth/image/bank_picture.inl"
