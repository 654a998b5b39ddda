// SPDX-License-Identifier: MIT
#include "freqsynth/image/finish_settings.inl"
