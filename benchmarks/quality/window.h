// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "quality/metrics.h"

namespace quality {

/// A part of a picture, in pixels.
struct Window {
  std::size_t x = 0, y = 0, width = 0, height = 0;
};

/// The part that shows most, for pictures side by side: with the greatest sum of differences
/// between the square roots of neighbouring values, among all places that are multiples of 8.
/// \param side  pixels, at least 1; a picture that is smaller is shown whole
[[nodiscard]] Window busiest_window(const PictureView& picture, std::size_t side);

}  // namespace quality
