// SPDX-License-Identifier: MIT
/// \file
/// What the samples within each pixel show, in a block and in the pixels around it.
///
/// A fit rings beside an edge, and a sample that stands for an area carries its value over the
/// border of its pixel. Beside a lamp that is a thousand times as bright both are light where there
/// is none. The samples that lie within pixels know better where these are flat.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The means of the samples that lie in each pixel of a block, row by row, and of the eight blocks
/// around it; the block itself is in the middle. Null where there is no block, or nothing is known.
using BlocksMeans = std::array<const float*, 9>;

/// Means of the samples that lie in each pixel of a block, and in each of the pixels around it.
class OwnMeans {
 public:
  /// Pixels in a row: those of the block and one on each side.
  static constexpr std::size_t side = block_size + 2;
  /// The mean in a pixel without samples: greater than any other.
  static constexpr float unknown = std::numeric_limits<float>::max();

  /// Those that are known.
  explicit OwnMeans(const BlocksMeans& blocks = {});

  /// That of a pixel, counted from the one above and to the left of the block's first.
  [[nodiscard]] float& at(std::size_t column, std::size_t row) {
    return values_[row * side + column];
  }
  /// The same, to be read only.
  [[nodiscard]] float at(std::size_t column, std::size_t row) const {
    return values_[row * side + column];
  }

  /// Holds pixels within what they and their neighbours show where these are flat. A pixel is what
  /// its samples and those of the neighbours that show the same are when two of these do and it is
  /// off by at most `ringing` times `range`; and however far off it is when all eight do.
  /// \param pixels  of the block, row by row
  /// \param range   of the block's pixels
  void hold(std::span<float, max_terms> pixels, float range, float ringing) const;

 private:
  std::array<float, side * side> values_;
};

// ------------------------------------------------------------------------------------ definitions

inline OwnMeans::OwnMeans(const BlocksMeans& blocks) {
  constexpr std::size_t last = block_size - 1;
  values_.fill(unknown);
  for (std::size_t row = 0; row < side; ++row) {
    const std::size_t line = row == 0 ? 0 : row < side - 1 ? 3 : 6;
    const std::size_t first = block_size * (row == 0 ? last : row < side - 1 ? row - 1 : 0);
    if (blocks[line]) at(0, row) = blocks[line][first + last];
    if (blocks[line + 1]) std::copy_n(blocks[line + 1] + first, block_size, &at(1, row));
    if (blocks[line + 2]) at(side - 1, row) = blocks[line + 2][first];
  }
}

inline void OwnMeans::hold(std::span<float, max_terms> pixels, float range, float ringing) const {
  // Flat beside an edge of that range: so that smooth slopes, which samples alone would make
  // coarse, are not.
  const float alike = 7e-4f * range;
  for (std::size_t y = 0; y < block_size; ++y) {
    std::array<float, block_size> low, high, count{};
    for (std::size_t x = 0; x < block_size; ++x) low[x] = high[x] = at(x + 1, y + 1);
    for (std::size_t row = y; row < y + 3; ++row) {
      for (std::size_t shift = 0; shift < 3; ++shift) {
        for (std::size_t x = 0; x < block_size; ++x) {
          const float own = at(x + 1, y + 1), other = at(x + shift, row);
          const bool same = std::abs(other - own) <= alike;
          low[x] = same ? std::min(low[x], other) : low[x];
          high[x] = same ? std::max(high[x], other) : high[x];
          count[x] += same ? 1.0f : 0.0f;
        }
      }
    }
    for (std::size_t x = 0; x < block_size; ++x) {
      constexpr float few = 3, all = 9;  // itself among them
      if (count[x] < few || low[x] == unknown) continue;
      float& pixel = pixels[y * block_size + x];
      const float held = std::clamp(pixel, low[x], high[x]);
      if (count[x] == all || std::abs(pixel - held) <= ringing * range) pixel = held;
    }
  }
}

}  // namespace freqsynth
