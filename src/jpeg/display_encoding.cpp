// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/display_encoding.inl"
