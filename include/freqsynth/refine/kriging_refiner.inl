// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <utility>

#include "freqsynth/basis/innovation_store.h"
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
    lists_.push_back(shared_innovations(rough, points, AverageGrid::of_node(positions.pixels(of))));
  }
}

/// In a fixed order, of eight sums.
FREQSYNTH_ROUNDING FREQSYNTH_INLINE float predicted_by(const InnovationRow& row,
                                                       const float* innovations) {
  FREQSYNTH_ROUNDING_BEGIN
  typedef float Lanes __attribute__((vector_size(16)));
  const float* factor = row.factor.data();
  Lanes even = {}, odd = {}, a, b;
  for (std::size_t i = 0; i < row.factor.size(); i += 8) {
    std::memcpy(&a, factor + i, sizeof a);
    std::memcpy(&b, innovations + i, sizeof b);
    even += a * b;
    std::memcpy(&a, factor + i + 4, sizeof a);
    std::memcpy(&b, innovations + i + 4, sizeof b);
    odd += a * b;
  }
  even += odd;
  return (even[0] + even[1]) + (even[2] + even[3]);
}

}  // namespace freqsynth
