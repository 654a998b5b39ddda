// SPDX-License-Identifier: MIT
#include "freqsynth/image/guided_regression.inl"
