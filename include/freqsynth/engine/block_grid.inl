// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {
namespace detail {

FREQSYNTH_INLINE double reflect(double x, double size) {
  x = std::fmod(x, 2 * size);
  return x > size ? 2 * size - x : x;
}

/// Share of the pixels of block `block` along one axis that the image shows.
inline double visible_share(std::size_t block, std::size_t size) {
  const std::size_t first = block * block_size;
  return static_cast<double>(std::min(size - first, block_size)) / block_size;
}

}  // namespace detail

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

FREQSYNTH_INLINE float BlockGrid::visible_share(std::size_t block) const {
  return static_cast<float>(detail::visible_share(column(block), width) *
                            detail::visible_share(row(block), height));
}

}  // namespace freqsynth
