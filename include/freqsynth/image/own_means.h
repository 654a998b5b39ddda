// SPDX-License-Identifier: MIT
/// \file
/// What the samples within each pixel show, in a block and in the pixels around it.
///
/// A fit rings beside an edge, and a sample that stands for an area carries its value over the
/// border of its pixel. Beside a lamp that is a thousand times as bright both are light where there
/// is none. The samples that lie within pixels know better where these are flat.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The means of the samples that lie in each pixel of a block, row by row, and of the eight blocks
/// around it; the block itself is in the middle. Null where there is no block, or nothing is known.
using BlocksMeans = std::array<const float*, 9>;

/// Means of the samples that lie in each pixel of a block, and in each of the pixels around it.
class FREQSYNTH_API OwnMeans {
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

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/own_means.inl"
#endif
