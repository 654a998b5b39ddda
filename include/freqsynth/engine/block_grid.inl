// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

FREQSYNTH_INLINE BlockGrid BlockGrid::of(std::size_t width, std::size_t height,
                                         std::size_t channels) {
  const auto refuse = [&](const char* why) {
    detail::refuse("image of " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels with " + std::to_string(channels) + " channels " + why);
  };
  if (channels == 0) refuse("has no channel");
  const std::size_t x = width / block_size + (width % block_size != 0);
  const std::size_t y = height / block_size + (height % block_size != 0);
  if (x == 0 || y == 0) return {0, 0, width, height};
  constexpr std::size_t most_blocks = std::numeric_limits<std::uint32_t>::max() - 1;
  if (x > most_blocks / y) refuse("has too many blocks");
  constexpr std::size_t most_floats =
      static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / sizeof(float);
  if (channels > most_floats / max_terms / (x * y)) refuse("is too large");
  return {x, y, width, height};
}

FREQSYNTH_INLINE void BlockGrid::check(const PixelWindow& window) const {
  const bool inside = window.x <= width && window.width <= width - window.x && window.y <= height &&
                      window.height <= height - window.y;
  if (inside && window.width > 0 && window.height > 0) return;
  detail::refuse("window is " + std::to_string(window.width) + " x " +
                 std::to_string(window.height) + " pixels at (" + std::to_string(window.x) + ", " +
                 std::to_string(window.y) + "), not a part of " + std::to_string(width) + " x " +
                 std::to_string(height) + " pixels");
}

}  // namespace freqsynth
