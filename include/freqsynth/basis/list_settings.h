// SPDX-License-Identifier: MIT
/// \file
/// What a list of inverse matrices (inverse_list.h) depends on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Where the samples of a block lie.
enum class SamplePositions : std::uint8_t {
  /// The lattice of the quad-tree, gently bent so that hardly two samples share a column or a row:
  /// as even as the lattice, but not blind to what repeats with it or runs along it.
  bent,
  /// The plain lattice of the paper, with many samples in each column and on pixel borders.
  lattice
};

/// What an inverse list depends on.
struct InverseListSettings {
  /// Samples per added term (paper, 4.2.1: two to three). At least 1; at low rates a term waits
  /// until the samples determine it.
  double samples_per_term = 2.5;
  /// Largest number of terms, 1..64.
  std::size_t max_terms = freqsynth::max_terms;
  /// Seed of the sequence's random choices.
  std::uint64_t seed = 0;
  /// Where the samples lie.
  SamplePositions positions = SamplePositions::bent;
};

}  // namespace freqsynth
