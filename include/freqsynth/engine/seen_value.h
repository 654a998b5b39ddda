// SPDX-License-Identifier: MIT
/// \file
/// A signal as errors in it are seen: relative to its size, or as a display shows it.
#pragma once

#include <algorithm>
#include <cmath>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/srgb.h"
#include "freqsynth/engine/priority.h"

namespace freqsynth::detail {

/// Of the median of what an image shows, the level below which relative errors count less.
inline constexpr double levels_of_median = 64;

/// g(value) of a Steer that is not linear.
/// \param level     below it Steer::relative is about linear, > 0
/// \param exposure  what Steer::display multiplies by, > 0
[[nodiscard]] inline double seen_value(Steer steer, double value, double level, double exposure) {
  if (steer == Steer::relative) return std::asinh(value / level);
  return srgb_of_linear(std::clamp(value * exposure, 0.0, 1.0));
}

/// The slope of the chord of that over middle - reach .. middle + reach.
/// \param reach  not negative; a chord has some length even so
[[nodiscard]] inline double seen_slope(Steer steer, double middle, double reach, double level,
                                       double exposure) {
  constexpr double least = 1e-6;
  const double small = steer == Steer::relative ? level : 1e-3 / exposure;
  reach = std::max(reach, least * std::max(std::abs(middle), small));
  return (seen_value(steer, middle + reach, level, exposure) -
          seen_value(steer, middle - reach, level, exposure)) /
         (2 * reach);
}

}  // namespace freqsynth::detail
