// SPDX-License-Identifier: MIT
#include "freqsynth/basis/box_covariance.inl"
