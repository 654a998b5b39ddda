// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <utility>

#include "freqsynth/basis/rounding.h"
#include "freqsynth/refine/kriging_refiner.h"

namespace freqsynth {

FREQSYNTH_INLINE KrigingRefiner::KrigingRefiner(const NodePositions& positions,
                                                std::vector<float> weights, double noise)
    : weights_(std::move(weights)) {
  const Covariance rough = Covariance::isotropic(CovarianceShape::exponential, length, noise);
  std::vector<UnitPoint> points(NodePositions::size);
  for (std::size_t of = 0; of < positions.classes(); ++of) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {positions.s(of, i), positions.t(of, i)};
    }
    lists_.push_back(std::make_unique<InnovationList>(rough, points,
                                                      AverageGrid::of_node(positions.pixels(of))));
  }
}

/// In a fixed order that compilers can vectorise.
FREQSYNTH_ROUNDING FREQSYNTH_INLINE float predicted_by(const InnovationRow& row,
                                                       const float* innovations) {
  FREQSYNTH_ROUNDING_BEGIN
  const float* factor = row.factor.data();
  std::array<float, 8> sums{};
  for (std::size_t i = 0; i < row.factor.size(); i += 8) {
    for (std::size_t k = 0; k < 8; ++k) sums[k] += factor[i + k] * innovations[i + k];
  }
  return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

}  // namespace freqsynth
