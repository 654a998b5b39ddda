// SPDX-License-Identifier: MIT
/// \file
/// Samples around a block of a tree, wherever the leaves that know them are by now.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/image/ring_samples.h"

namespace freqsynth::detail {

/// A sample that a leaf has.
struct LeafSample {
  std::uint32_t leaf = TreeNode::none;  ///< none: nobody has it
  std::uint32_t index = 0;              ///< of its sequence
};

/// The rings of the blocks of trees.
class TreeRings {
 public:
  explicit TreeRings(const NodePositions& positions);

  /// Number of rings: 1 is that of the fewest samples, 0 none.
  [[nodiscard]] std::size_t size() const { return rings_.size(); }
  /// Positions of a ring's samples, and then those of a block.
  [[nodiscard]] std::vector<UnitPoint> positions(std::size_t ring) const {
    return with_ring(rings_[ring - 1], block_);
  }
  /// The ring with the most samples of which all are known; 0: there is none. Blocks at the
  /// picture's border, and beside narrower ones, have none.
  [[nodiscard]] std::size_t ring_of(const NodeTree& tree, std::uint32_t block) const;
  /// Calls visit(sample) for each LeafSample of a ring of a block until it returns false.
  /// \return whether it did not
  template <class Visit>
  bool visit(const NodeTree& tree, std::uint32_t block, std::size_t ring, Visit&& visit) const {
    for (const RingSample& sample : rings_[ring - 1]) {
      const auto x = static_cast<std::ptrdiff_t>(tree.grid().column(block)) + sample.right;
      const auto y = static_cast<std::ptrdiff_t>(tree.grid().row(block)) + sample.down;
      const auto columns = static_cast<std::ptrdiff_t>(tree.grid().blocks_x);
      if (!visit(find(tree, static_cast<std::uint32_t>(y * columns + x), sample.index))) {
        return false;
      }
    }
    return true;
  }
  /// Who has sample `index` of a node by now.
  [[nodiscard]] LeafSample find(const NodeTree& tree, std::uint32_t node, std::size_t index) const;

 private:
  /// Where a sample of a node is in a quadrant.
  struct Place {
    std::uint32_t quadrant = 4, index = 0;
  };

  std::vector<UnitPoint> block_;
  std::vector<std::vector<RingSample>> rings_;
  std::vector<Place> places_;
};

// ------------------------------------------------------------------------------------ definitions

inline TreeRings::TreeRings(const NodePositions& positions) : places_(NodePositions::size) {
  for (std::size_t i = 0; i < NodePositions::size; ++i) {
    block_.push_back({positions.s(0, i), positions.t(0, i)});
  }
  for (const RingReach& which : ring_reaches) rings_.push_back(ring_samples(block_, which));
  for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
    for (std::uint32_t i = 0; i < NodePositions::handed_down(NodePositions::size); ++i) {
      places_[positions.in_parent(quadrant, i)] = {quadrant, i};
    }
  }
}

inline LeafSample TreeRings::find(const NodeTree& tree, std::uint32_t node,
                                  std::size_t index) const {
  while (!tree.node(node).leaf()) {
    const TreeNode& split = tree.node(node);
    const Place& place = places_[index];
    if (!tree.positions().same_place(split.of, place.quadrant, place.index)) return {};
    node = split.quadrants + place.quadrant;
    index = place.index;
  }
  if (index >= tree.node(node).samples) return {};
  return {node, static_cast<std::uint32_t>(index)};
}

inline std::size_t TreeRings::ring_of(const NodeTree& tree, std::uint32_t block) const {
  const BlockGrid& grid = tree.grid();
  const std::size_t x = grid.column(block), y = grid.row(block);
  if (x == 0 || y == 0 || (x + 2) * block_size > grid.width || (y + 2) * block_size > grid.height) {
    return 0;
  }
  std::size_t least = NodePositions::size;
  tree.visit_blocks_around(block, [&](std::uint32_t other) {
    const TreeNode& node = tree.node(other);
    least = std::min<std::size_t>(least, node.samples);
  });
  for (std::size_t ring = size(); ring > 0; --ring) {
    if (least < ring_reaches[ring - 1].level) continue;
    const bool all = visit(tree, block, ring,
                           [](const LeafSample& sample) { return sample.leaf != TreeNode::none; });
    if (all) return ring;
  }
  return 0;
}

}  // namespace freqsynth::detail
