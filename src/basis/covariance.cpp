// SPDX-License-Identifier: MIT
#include "freqsynth/basis/covariance.inl"
