// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/basis/check.h"
#include "freqsynth/engine/tree_settings.h"

namespace freqsynth {

FREQSYNTH_INLINE void TreeSettings::validate() const {
  // Places have names of 32 bits along each axis.
  constexpr std::size_t most = (std::size_t{1} << 21) - 1;
  detail::require(width <= most, "width", static_cast<double>(width), "below 2^21");
  detail::require(height <= most, "height", static_cast<double>(height), "below 2^21");
  detail::require(!weights.empty(), "channels", 0, ">= 1");
  for (const float weight : weights) {
    detail::require(weight >= 0 && weight <= 1e6f, "weight", double{weight}, "in 0..1e6");
  }
  detail::require(perturbation >= 0 && perturbation <= 0.45, "perturbation", perturbation,
                  "in [0, 0.45]");
  detail::require(depth <= 5, "depth", static_cast<double>(depth), "in 0..5");
  detail::require(exploration >= 0 && exploration <= 1, "exploration", exploration, "in [0, 1]");
  detail::require(exposure >= 1e-30 && exposure <= 1e30, "exposure", exposure, "in 1e-30..1e30");
}

}  // namespace freqsynth
