// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/image/finish_settings.h"

namespace freqsynth {

FREQSYNTH_INLINE void FinishSettings::validate() const {
  butterworth.validate();
  const auto check = [](double value, const char* name) {
    detail::require(detail::is_finite(value) && value >= 0, name, value, "a finite number >= 0");
  };
  check(doubt, "doubt");
  check(noisy_doubt, "noisy_doubt");
  check(shrinkage, "shrinkage");
  check(ringing, "ringing");
  detail::require(!detail::is_nan(slack) && slack >= 0, "slack", slack, ">= 0");
}

}  // namespace freqsynth
