// SPDX-License-Identifier: MIT
#include "freqsynth/synthesizer.inl"
