// SPDX-License-Identifier: MIT
#include "freqsynth/image/error_estimate.inl"
