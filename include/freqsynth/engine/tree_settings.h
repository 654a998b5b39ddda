// SPDX-License-Identifier: MIT
/// \file
/// What the sampling of a tree of nodes depends on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/priority.h"

namespace freqsynth {

/// Settings of a TreeSampler.
struct TreeSettings {
  std::size_t width = 0;   ///< of the image, in pixels, below 2^21
  std::size_t height = 0;  ///< the same
  /// Weight of each channel's squared errors; one for each channel, in 0..1e6. Only the proportions
  /// matter. 0: the channel rides along.
  std::vector<float> weights = {1, 1, 1};
  std::uint64_t seed = 0;  ///< of all random choices
  /// Values are Monte Carlo estimates: nodes are not split, nothing is moved, and a block takes up
  /// to 1089 samples.
  bool noisy = false;
  /// Greatest move of a block's first samples; see NodePositions.
  double perturbation = 0.3;
  /// Greatest depth of a node, 0..5: 5 is a quarter of a pixel.
  std::size_t depth = 5;
  /// Most leaves of a wave; 0: 1/32 of all. The picture depends on it.
  std::size_t wave = 0;
  /// Leaves do not stay behind the others for good, however flat they look: when blocks of 8 x 8
  /// pixels have been asked for m samples on average, leaves with fewer than m^exploration, by
  /// their area, come first. In [0, 1]; 0: never.
  /// Otherwise what looks flat after 5 samples stays so while others want some.
  double exploration = 0.82;
  Steer steer = Steer::linear;  ///< in what unit errors count
  double exposure = 1;          ///< see PrioritySettings::exposure

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate() const;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/engine/tree_settings.inl"
#endif
