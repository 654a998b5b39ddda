// SPDX-License-Identifier: MIT
/// \file
/// A picture from the leaves of a tree by a bank of priors (refine/prior_bank.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/image/node_pixels.h"
#include "freqsynth/refine/bank_estimator.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {

/// Makes pictures of trees. Its lists, one for each prior and class of nodes, are built when they
/// are needed, and stay for the next picture.
///
/// Each leaf is estimated from its own samples: those around have no part in it.
class TreePictures {
 public:
  /// \param positions  of the trees' nodes; must live as long as this
  explicit TreePictures(const NodePositions& positions, PriorBank bank = PriorBank::exact(),
                        const BankSettings& weights = {})
      : positions_(&positions), bank_(std::move(bank)), weights_(weights) {
    lists_.resize(positions.classes());
  }

  /// The pixels of a tree with these positions, see node_pixels(). Leaves that wait, or have had no
  /// sample, show the mean of what they know. \throws std::bad_alloc.
  [[nodiscard]] std::vector<float> pixels(const NodeTree& tree);

  /// Bytes that the lists built so far take.
  [[nodiscard]] std::size_t memory() const {
    std::size_t bytes = 0;
    for (const auto& lists : lists_) bytes += lists != nullptr ? lists->memory() : 0;
    return bytes;
  }

 private:
  [[nodiscard]] const BankLists& lists(std::size_t of);
  void estimate(const NodeTree& tree, std::size_t of, std::span<const std::uint32_t> leaves);
  [[nodiscard]] std::span<float> averages(const NodeTree& tree, std::uint32_t leaf) {
    const std::size_t side = positions_->pixels(tree.node(leaf).of);
    return std::span(averages_).subspan(places_[leaf], side * side * tree.channels());
  }

  const NodePositions* positions_;
  PriorBank bank_;
  BankSettings weights_;
  std::vector<std::unique_ptr<BankLists>> lists_;  // of each class
  // Of one picture: the averages of all leaves, channel by channel, and where those of each begin.
  std::vector<float> averages_;
  std::vector<std::size_t> places_;
  std::vector<float> values_;
};

// ------------------------------------------------------------------------------------ definitions

inline const BankLists& TreePictures::lists(std::size_t of) {
  if (lists_[of] == nullptr) {
    std::vector<UnitPoint> points(NodePositions::size);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {positions_->s(of, i), positions_->t(of, i)};
    }
    lists_[of] =
        std::make_unique<BankLists>(bank_, points, AverageGrid::of_node(positions_->pixels(of)));
  }
  return *lists_[of];
}

inline void TreePictures::estimate(const NodeTree& tree, std::size_t of,
                                   std::span<const std::uint32_t> leaves) {
  constexpr std::size_t together = 128;
  BankEstimator estimator(lists(of), tree.channels(), weights_);
  std::vector<BankNode> nodes;
  for (std::size_t first = 0; first < leaves.size(); first += together) {
    const auto some = leaves.subspan(first, std::min(together, leaves.size() - first));
    std::size_t size = 0;
    for (const std::uint32_t leaf : some) size += tree.node(leaf).samples * tree.channels();
    values_.resize(size);
    nodes.clear();
    float* next = values_.data();
    for (const std::uint32_t leaf : some) {
      BankNode node;
      node.values = next;
      node.count = tree.node(leaf).samples;
      node.averages = averages(tree, leaf).data();
      for (std::size_t c = 0; c < tree.channels(); ++c) {
        const std::span<const float> values = tree.values(leaf, c);
        for (std::size_t i = 0; i < values.size(); ++i) next[i * tree.channels() + c] = values[i];
      }
      next += node.count * tree.channels();
      nodes.push_back(node);
    }
    estimator.estimate(nodes);
  }
}

inline std::vector<float> TreePictures::pixels(const NodeTree& tree) {
  FREQSYNTH_ASSERT(&tree.positions() == positions_);
  std::vector<std::vector<std::uint32_t>> leaves(positions_->classes());
  places_.assign(tree.size(), 0);
  std::size_t size = 0;
  for (std::uint32_t number = 0; number < tree.size(); ++number) {
    const TreeNode& node = tree.node(number);
    if (!node.leaf() || node.samples == 0 || tree.waits(number)) continue;
    leaves[node.of].push_back(number);
    places_[number] = size;
    size += positions_->pixels(node.of) * positions_->pixels(node.of) * tree.channels();
  }
  averages_.resize(size);
  for (std::size_t of = 0; of < leaves.size(); ++of) {
    if (!leaves[of].empty()) estimate(tree, of, leaves[of]);
  }
  return node_pixels(tree, [&](std::uint32_t leaf, std::size_t channel, std::span<float> parts) {
    if (tree.node(leaf).samples == 0 || tree.waits(leaf)) {
      std::fill(parts.begin(), parts.end(), tree.known_mean(leaf, channel));
      return;
    }
    const std::span<const float> own = averages(tree, leaf);
    std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(channel * parts.size()), parts.size(),
                parts.begin());
  });
}

}  // namespace freqsynth
