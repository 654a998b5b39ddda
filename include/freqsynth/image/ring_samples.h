// SPDX-License-Identifier: MIT
/// \file
/// The samples around a block that have a part in its estimate.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/covariance.h"

namespace freqsynth::detail {

/// A sample of a block around.
struct RingSample {
  int right, down;    ///< of the block: -1, 0 or 1
  std::size_t index;  ///< of its sample
};

/// Which samples of the blocks around make a ring, by how many all of these have.
struct RingReach {
  std::size_t level;  ///< samples that each block has
  double reach;       ///< greatest distance from the block's border, in its edges
};
inline constexpr std::array<RingReach, 3> ring_reaches{{{25, 0.5}, {81, 0.25}, {289, 0.125}}};

/// The samples of a ring, in the order of the sequence. Those on the block's own border are its
/// own, and those on a border of two others are there once.
/// \param positions  those of the samples of each block
inline std::vector<RingSample> ring_samples(std::span<const UnitPoint> positions,
                                            const RingReach& which) {
  const auto outside = [](double at) { return at < 0 ? -at : at > 1 ? at - 1 : 0; };
  std::vector<RingSample> ring;
  std::vector<UnitPoint> known;
  for (std::size_t index = 0; index < which.level; ++index) {
    for (int down = -1; down <= 1; ++down) {
      for (int right = -1; right <= 1; ++right) {
        const UnitPoint at{positions[index].s + right, positions[index].t + down};
        const double distance = std::max(outside(at.s), outside(at.t));
        if (!(distance > 0 && distance <= which.reach + 1e-9)) continue;
        const bool twice = std::any_of(known.begin(), known.end(), [&](const UnitPoint& other) {
          return at.s == other.s && at.t == other.t;
        });
        if (twice) continue;
        known.push_back(at);
        ring.push_back({right, down, index});
      }
    }
  }
  return ring;
}

/// The positions of a ring's samples and then those of the block itself.
inline std::vector<UnitPoint> with_ring(std::span<const RingSample> ring,
                                        std::span<const UnitPoint> positions) {
  std::vector<UnitPoint> all;
  for (const RingSample& sample : ring) {
    const UnitPoint at = positions[sample.index];
    all.push_back({at.s + sample.right, at.t + sample.down});
  }
  all.insert(all.end(), positions.begin(), positions.end());
  return all;
}

/// The share of an estimate in a pixel, along one axis, whose centre lies `inside` pixels from a
/// border that two share, and are blended across `blend` pixels to both sides.
constexpr float blend_share(double inside, std::size_t blend) {
  if (blend == 0) return inside > 0 ? 1 : 0;
  const double share = 0.5 + inside / (2 * static_cast<double>(blend));
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

}  // namespace freqsynth::detail
