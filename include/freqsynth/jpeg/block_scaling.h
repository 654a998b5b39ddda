// SPDX-License-Identifier: MIT
/// \file
/// Linear maps between blocks of pixels of different sizes, in frequencies: how chroma is halved
/// and enlarged without making a pixel.
#pragma once

#include <cstddef>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// A map of 8 frequencies of one axis to 8 others.
class FREQSYNTH_API AxisMap {
 public:
  /// Block `part` (of `factor` along the axis) to its share of the block of means of `factor`
  /// pixels.
  static AxisMap shrink(std::size_t part, std::size_t factor) { return {part, factor, false}; }

  /// A block to part `part` of the `factor` blocks in which each pixel is repeated `factor` times.
  static AxisMap enlarge(std::size_t part, std::size_t factor) { return {part, factor, true}; }

  /// Sets `out` to the coefficients of `block`, another one, after both axes. Both are in rows of
  /// frequencies [v][u]. Not returned by value: gcc 12 without optimisation may put what is
  /// returned where it is not aligned.
  static void apply(const AxisMap& across, const AxisMap& down, const AlignedBlock& block,
                    AlignedBlock& out);

 private:
  AxisMap(std::size_t part, std::size_t factor, bool enlarge);

  AlignedBlock to_from_;  // [to][from]
  AlignedBlock from_to_;  // transposed
};

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/block_scaling.inl"
#endif
