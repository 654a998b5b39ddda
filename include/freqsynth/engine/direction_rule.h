// SPDX-License-Identifier: MIT
/// \file
/// A rule that keeps nodes whole where one direction, or smoothness, explains all of them.
///
/// Where stripes or a smooth function fill a node, its samples together tell their direction and
/// course better than those of each quadrant would. Where an edge runs through some quadrants, the
/// others need no more samples: then it is better split. So a node goes on as one if
/// 1. the evidence of an oriented or a smooth prior exceeds that of the rough one that steers by
///    `margin`, a natural logarithm, and
/// 2. all quadrants have to do: with e_k the mean squares, in each, of the rough one's innovations
///    since the lattice before this one, samples in proportion to the roots of e_k would lessen the
///    error by the factor
///      sum e_k / 4 / (sum sqrt(e_k) / 4)^2,
///    which is 4/3 where one quadrant has nothing to do and the others the same. It must be below.
///    Where none has to do, samples come for what the nodes beside show alone; split, it is rid of
///    these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/innovation_list.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/engine/split_rule.h"

namespace freqsynth {

/// Evidence, and what quadrants have to do.
class DirectionRule final : public SplitRule {
 public:
  /// How much better an oriented or smooth prior has to be.
  static constexpr double margin = 3;
  /// What splitting must not gain.
  static constexpr double usual_gain = 4.0 / 3;
  /// Nodes below this depth are always split.
  static constexpr int deepest = 1;

  /// \param most_gain  see usual_gain; more than 4: it does not matter
  /// \throws std::bad_alloc.
  explicit DirectionRule(double most_gain = usual_gain);

  bool goes_on(const NodeTree& tree, std::uint32_t leaf) override;

  /// The priors: first the rough one, then those that are oriented or smooth.
  [[nodiscard]] std::span<const Covariance> priors() const { return priors_; }
  /// What samples where they are needed would gain over even ones, 1..4; 4 where nothing changes.
  [[nodiscard]] static double gain_of_split(const NodeTree& tree, std::uint32_t leaf);
  /// Logarithm of the evidence of a prior for a leaf with more than one sample. Its scale is what
  /// suits the samples of all channels best, by their weights. Up to a constant of the leaf.
  [[nodiscard]] double evidence(const NodeTree& tree, std::uint32_t leaf, std::size_t prior);

 private:
  [[nodiscard]] const InnovationList& list(const NodePositions& positions, std::size_t of,
                                           std::size_t prior);

  double most_gain_;
  std::vector<Covariance> priors_;
  const NodePositions* positions_ = nullptr;                  // that the lists are for
  std::vector<std::shared_ptr<const InnovationList>> lists_;  // of each class and prior
  detail::AlignedVector<float> innovations_;
};

}  // namespace freqsynth

#include "freqsynth/engine/direction_rule.inl"
