// SPDX-License-Identifier: MIT
/// \file
/// Linear maps between blocks of pixels of different sizes, in frequencies: how chroma is halved
/// and enlarged, and narrow blocks are extended to whole ones, without making a pixel.
#pragma once

#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// A map of 8 frequencies of one axis to 8 others.
class FREQSYNTH_API AxisMap {
 public:
  /// Block `part` (of `factor` along the axis) to its share of the block of means of `factor`
  /// pixels.
  static AxisMap shrink(std::size_t part, std::size_t factor) {
    return {Kind::shrink, part, factor};
  }

  /// A block to part `part` of the `factor` blocks in which each pixel is repeated `factor` times.
  static AxisMap enlarge(std::size_t part, std::size_t factor) {
    return {Kind::enlarge, part, factor};
  }

  /// A block `length` (1..8) pixels long, whose unit square is stretched over that, to the block of
  /// 8 pixels that begins with the means of those and goes on as in a mirror.
  static AxisMap extend(std::size_t length) { return {Kind::extend, 0, length}; }

  /// Sets `out` to the coefficients of `block`, another one, after both axes. Both are in rows of
  /// frequencies [v][u]. Not returned by value: gcc 12 without optimisation may put what is
  /// returned where it is not aligned.
  static void apply(const AxisMap& across, const AxisMap& down, const AlignedBlock& block,
                    AlignedBlock& out);

 private:
  enum class Kind : std::uint8_t { shrink, enlarge, extend };
  AxisMap(Kind kind, std::size_t part, std::size_t factor);

  AlignedBlock to_from_;  // [to][from]
  AlignedBlock from_to_;  // transposed
};

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/block_scaling.inl"
#endif
