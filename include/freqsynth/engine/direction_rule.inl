// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "freqsynth/basis/innovation_store.h"
#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/refine/kriging_refiner.h"

namespace freqsynth {

inline DirectionRule::DirectionRule(double most_gain) : most_gain_(most_gain) {
  using enum CovarianceShape;
  priors_ = {
      Covariance::isotropic(exponential, 0.7, 0.003), Covariance::isotropic(matern32, 0.35, 0.001),
      Covariance::isotropic(matern52, 0.4, 0.001), Covariance::isotropic(matern52, 1.5, 1e-4)};
  constexpr int directions = 16;
  for (int i = 0; i < directions; ++i) {
    const double angle = std::numbers::pi * i / directions;
    priors_.push_back(Covariance::oriented(exponential, 20, 1, angle, 0.003));
    priors_.push_back(Covariance::oriented(matern32, 8, 0.4, angle, 0.001));
  }
}

inline bool DirectionRule::goes_on(const NodeTree& tree, std::uint32_t leaf) {
  if (tree.node(leaf).depth > deepest) return false;
  if (gain_of_split(tree, leaf) >= most_gain_) return false;
  const double rough = evidence(tree, leaf, 0);
  for (std::size_t prior = 1; prior < priors_.size(); ++prior) {
    if (evidence(tree, leaf, prior) - rough > margin) return true;
  }
  return false;
}

inline double DirectionRule::gain_of_split(const NodeTree& tree, std::uint32_t leaf) {
  const TreeNode& node = tree.node(leaf);
  const std::span<const NodePosition> positions = tree.positions().of(node.of);
  std::array<double, 4> squares{}, counts{};
  // Those since the lattice before this one: what came earlier tells of all of the node.
  const std::size_t first = std::max<std::size_t>(NodePositions::handed_down(node.samples), 1);
  for (std::size_t i = first; i < node.samples; ++i) {
    double square = 0;
    for (std::size_t c = 0; c < tree.channels(); ++c) {
      const double innovation = tree.innovations(leaf, c)[i];
      square += double{tree.refiner().weights()[c]} * innovation * innovation;
    }
    // On a border between quadrants it belongs to both.
    constexpr std::int32_t middle = NodePositions::edge / 2;
    for (std::size_t k = 0; k < 4; ++k) {
      const NodePosition& p = positions[i];
      if (k % 2 == 0 ? p.s > middle : p.s < middle) continue;
      if (k / 2 == 0 ? p.t > middle : p.t < middle) continue;
      squares[k] += square;
      ++counts[k];
    }
  }
  double sum = 0, roots = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double mean = counts[k] > 0 ? squares[k] / counts[k] : 0;
    sum += mean;
    roots += std::sqrt(mean);
  }
  return roots > 0 ? 4 * sum / (roots * roots) : 4;
}

inline double DirectionRule::evidence(const NodeTree& tree, std::uint32_t leaf, std::size_t prior) {
  const TreeNode& node = tree.node(leaf);
  const InnovationList& rows = list(tree.positions(), node.of, prior);
  rows.reserve(node.samples);
  const std::size_t samples = node.samples;
  double sum = 0;
  for (std::size_t c = 0; c < tree.channels(); ++c) {
    const std::span<const float> values = tree.values(leaf, c);
    innovations_.assign((samples + 7) / 8 * 8, 0.0f);
    double squares = 0;
    for (std::size_t i = 1; i < samples; ++i) {
      const float innovation =
          innovation_of(rows.row(i), innovations_.data(), values[i] - values[0]);
      innovations_[i] = innovation;
      squares += double{innovation} * double{innovation};
    }
    sum += double{tree.refiner().weights()[c]} * squares;
  }
  const auto freedom = static_cast<double>(samples - 1);
  constexpr double least = 1e-12;  // of a constant
  return -0.5 *
         (freedom * detail::log_of(sum / freedom + least) + rows.row(samples - 1).log_determinant);
}

inline const InnovationList& DirectionRule::list(const NodePositions& positions, std::size_t of,
                                                 std::size_t prior) {
  if (positions_ != &positions) {
    lists_.clear();
    lists_.resize(positions.classes() * priors_.size());
    positions_ = &positions;
  }
  std::shared_ptr<const InnovationList>& list = lists_[of * priors_.size() + prior];
  if (list == nullptr) {
    std::vector<UnitPoint> points(81);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {positions.s(of, i), positions.t(of, i)};
    }
    // Of averages nothing is asked.
    list = shared_innovations(priors_[prior], points, AverageGrid::of_node(1));
  }
  return *list;
}

}  // namespace freqsynth
