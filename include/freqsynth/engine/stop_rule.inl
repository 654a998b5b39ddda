// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/stop_rule.h"

namespace freqsynth {

FREQSYNTH_INLINE void StopRule::validate() const {
  const auto check = [](double value, const char* name) {
    detail::require(!detail::is_nan(value) && value >= 0, name, value, ">= 0");
  };
  check(samples_per_pixel, "samples_per_pixel");
  check(seconds, "seconds");
  check(target_rmse, "target_rmse");
  check(aliasing_threshold, "aliasing_threshold");
}

FREQSYNTH_INLINE std::uint64_t StopRule::most_samples(std::size_t width, std::size_t height) const {
  if (!detail::is_finite(samples_per_pixel)) return samples;
  const double most =
      std::round(samples_per_pixel * static_cast<double>(width) * static_cast<double>(height));
  return most < static_cast<double>(samples) ? static_cast<std::uint64_t>(most) : samples;
}

}  // namespace freqsynth
