// SPDX-License-Identifier: MIT
/// \file
/// What errors of each node of a tree are worth where it is not the signal's own unit that counts;
/// what Steering is to blocks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/engine/seen_value.h"

namespace freqsynth {

/// Sets the factors of nodes.
class TreeSteering {
 public:
  /// \param exposure  see PrioritySettings::exposure
  TreeSteering(Steer steer, double exposure, std::size_t channels)
      : steer_(steer), exposure_(exposure), levels_(channels, 1.0), factors_(channels) {}

  /// Whether all factors stay 1.
  [[nodiscard]] bool linear() const { return steer_ == Steer::linear; }
  /// Whether anything is known of the signal: once every block has had a sample.
  [[nodiscard]] bool settled() const { return settled_; }

  /// Every block has had a sample: sets the factors of all leaves that have.
  /// \throws std::bad_alloc, and it is not settled.
  void settle(NodeTree& tree);
  /// Sets those of a leaf, if it is one, once more.
  void look_at(NodeTree& tree, std::uint32_t leaf);

 private:
  friend struct TreeArchive;

  [[nodiscard]] static double mean(std::span<const float> values);
  void set_level(const NodeTree& tree, std::size_t channel);
  void set_factors(NodeTree& tree, std::uint32_t leaf);

  Steer steer_;
  double exposure_;
  bool settled_ = false;
  std::vector<double> levels_;
  std::vector<float> factors_;
};

// ------------------------------------------------------------------------------------ definitions

inline double TreeSteering::mean(std::span<const float> values) {
  double sum = 0;
  for (const float value : values) sum += double{value};
  return sum / static_cast<double>(values.size());
}

inline void TreeSteering::settle(NodeTree& tree) {
  for (std::size_t c = 0; c < levels_.size(); ++c) {
    if (steer_ == Steer::relative) set_level(tree, c);
  }
  settled_ = true;
  if (linear()) return;
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    if (tree.node(leaf).leaf() && tree.node(leaf).samples > 0) set_factors(tree, leaf);
  }
}

inline void TreeSteering::set_level(const NodeTree& tree, std::size_t channel) {
  std::vector<double> sizes;
  for (std::uint32_t block = 0; block < tree.grid().size(); ++block) {
    if (!tree.node(block).leaf()) continue;
    const double size = std::abs(mean(tree.values(block, channel)));
    if (size > 0) sizes.push_back(size);
  }
  if (sizes.empty()) return;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  levels_[channel] = *middle / detail::levels_of_median;
}

inline void TreeSteering::look_at(NodeTree& tree, std::uint32_t leaf) {
  if (linear() || !settled_ || !tree.node(leaf).leaf()) return;
  // A quadrant that waits for its first corner knows nothing yet.
  if (tree.node(leaf).samples == 0) return;
  set_factors(tree, leaf);
}

inline void TreeSteering::set_factors(NodeTree& tree, std::uint32_t leaf) {
  for (std::size_t c = 0; c < levels_.size(); ++c) {
    const std::span<const float> values = tree.values(leaf, c);
    const double middle = mean(values);
    double squares = 0;
    for (const float value : values) squares += (value - middle) * (value - middle);
    const double reach = std::sqrt(squares / static_cast<double>(values.size()));
    const double slope = detail::seen_slope(steer_, middle, reach, levels_[c], exposure_);
    // Finite, where values are tiny.
    factors_[c] = static_cast<float>(std::min(slope * slope, 1e38));
  }
  tree.set_factors(leaf, factors_);
}

}  // namespace freqsynth
