// SPDX-License-Identifier: MIT
/// \file
/// Pixels below zero of a function that is not.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "freqsynth/basis/config.h"

namespace freqsynth {
namespace detail {

/// Makes pixels below zero zero, and the others smaller in proportion, so that their sum stays.
inline void lift_negative(std::span<float, max_terms> pixels) {
  int any = 0;
  for (const float pixel : pixels) any |= pixel < 0 ? 1 : 0;
  if (any == 0) return;
  float above = 0, below = 0;
  for (const float pixel : pixels) (pixel > 0 ? above : below) += pixel;
  const float share = above > -below ? (above + below) / above : 0;
  for (float& pixel : pixels) pixel = std::max(pixel, 0.0f) * share;
}

}  // namespace detail
}  // namespace freqsynth
