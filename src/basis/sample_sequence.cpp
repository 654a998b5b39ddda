// SPDX-License-Identifier: MIT
#include "freqsynth/basis/sample_sequence.inl"
