// SPDX-License-Identifier: MIT
#include "freqsynth/image/reconstructor.inl"
