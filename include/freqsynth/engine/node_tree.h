// SPDX-License-Identifier: MIT
/// \file
/// Blocks that split into quadrants, and these again: the tree of nodes, what each has been told,
/// and how samples are shared by nodes that touch and handed down when a node is split.
///
/// Every node follows the sequence of its class (basis/node_positions.h). A point on the border of
/// nodes is known to all that touch it: a node looks for it, by its place, among the leaves around.
/// So nothing is kept twice, but by the nodes themselves.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/node_store.h"
#include "freqsynth/refine/kriging_refiner.h"

namespace freqsynth {

/// A node: a block, or a quadrant of another node.
struct TreeNode {
  /// No node.
  static constexpr std::uint32_t none = 0xffffffffu;

  std::uint32_t block = 0;         ///< that it is a part of
  std::uint16_t column = 0;        ///< among the nodes of its depth in the block
  std::uint16_t row = 0;           ///< the same, downwards
  std::uint8_t depth = 0;          ///< 0 for a block, one more for each split
  std::uint8_t of = 0;             ///< its class, see NodePositions
  std::uint16_t held = 0;          ///< samples that were handed down, some of which may wait
  std::uint8_t held_corners = 0;   ///< bit k: sample k < 4 is among them
  std::uint16_t limit = 0;         ///< samples after which it is split, or full
  std::uint16_t samples = 0;       ///< that it has taken in
  std::uint32_t parent = none;     ///< that it is a quadrant of
  std::uint32_t quadrants = none;  ///< the first of its four
  float scale = 0;                 ///< mean squared innovation when it last took one in, weighted
  NodeStore::Chunk chunk;          ///< what it has been told; none once it is split

  /// Whether it has not been split.
  [[nodiscard]] bool leaf() const { return quadrants == none; }
  /// Whether it takes in no more.
  [[nodiscard]] bool complete() const { return samples >= limit; }
};

/// Where a point lies in the grid of blocks: in steps, of which NodePositions::edge are a block.
struct TreePlace {
  std::int64_t x = 0;  ///< steps to the right
  std::int64_t y = 0;  ///< steps downwards

  /// Whether both are the same.
  friend bool operator==(const TreePlace& a, const TreePlace& b) {
    return a.x == b.x && a.y == b.y;
  }
};

/// All nodes of an image. The first ones are its blocks.
class NodeTree {
 public:
  /// First samples that a node may be without, where later ones were handed down.
  static constexpr std::size_t corners = 4;
  /// Greatest depth: positions are whole steps that far down.
  static constexpr std::size_t deepest = 5;

  /// \param limit    samples of a block, see TreeNode::limit; 1 to NodePositions::size
  /// \param weights  of each channel, not negative; at least one channel
  /// \throws std::invalid_argument like NodePositions and KrigingRefiner.
  NodeTree(const BlockGrid& grid, const NodePositions& positions, std::size_t limit,
           std::vector<float> weights, double noise);
  /// A copy, which shares the lists. \throws std::bad_alloc.
  NodeTree(const NodeTree& other);
  NodeTree& operator=(const NodeTree&) = delete;

  /// Where blocks lie.
  [[nodiscard]] const BlockGrid& grid() const { return grid_; }
  /// Where samples lie.
  [[nodiscard]] const NodePositions& positions() const { return *positions_; }
  /// What estimates their scale.
  [[nodiscard]] const KrigingRefiner& refiner() const { return refiner_; }
  /// Their memory.
  [[nodiscard]] const NodeStore& store() const { return store_; }
  /// Values per sample.
  [[nodiscard]] std::size_t channels() const { return refiner_.channels(); }
  /// Number of nodes.
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// A node.
  [[nodiscard]] const TreeNode& node(std::uint32_t number) const { return nodes_[number]; }
  /// Samples that nodes have taken in, each as often as nodes did; what is handed down anew.
  [[nodiscard]] std::uint64_t absorbed() const { return absorbed_; }

  /// Values of a channel that a leaf has been told, in the order of its sequence.
  [[nodiscard]] std::span<const float> values(std::uint32_t leaf, std::size_t channel) const {
    const TreeNode& node = nodes_[leaf];
    return {store_.row(node.chunk, 2 * channel), node.samples};
  }
  /// The innovations of these.
  [[nodiscard]] std::span<const float> innovations(std::uint32_t leaf, std::size_t channel) const {
    const TreeNode& node = nodes_[leaf];
    return {store_.row(node.chunk, 2 * channel + 1), node.samples};
  }
  /// Whether a leaf waits for a corner before it can take in what was handed down to it.
  [[nodiscard]] bool waits(std::uint32_t leaf) const {
    return nodes_[leaf].samples < nodes_[leaf].held;
  }
  /// Calls visit(index, value) for each value of a channel that a leaf knows, those that wait
  /// included.
  template <class Visit>
  void visit_known(std::uint32_t leaf, std::size_t channel, Visit&& visit) const {
    const TreeNode& node = nodes_[leaf];
    for (std::uint32_t i = 0; i < std::max(node.samples, node.held); ++i) {
      if (has(node, i)) visit(i, store_.row(node.chunk, 2 * channel)[i]);
    }
  }
  /// Mean of all values of a channel that a leaf knows, those that wait included; 0 without any.
  [[nodiscard]] float known_mean(std::uint32_t leaf, std::size_t channel) const;
  /// The expected squared error of that mean, if values had nothing to do with each other; 0 with
  /// fewer than two.
  [[nodiscard]] double known_error(std::uint32_t leaf, std::size_t channel) const;
  /// Sum of the squares of the innovations of a channel.
  [[nodiscard]] float squares(std::uint32_t leaf, std::size_t channel) const {
    return nodes_[leaf].chunk.data[channel];
  }
  /// The same of all channels, by their weights and factors.
  [[nodiscard]] double squares(std::uint32_t leaf) const;
  /// Sets what squared errors of each channel are worth in a leaf that has had a sample, at first
  /// 1. Quadrants inherit it.
  void set_factors(std::uint32_t leaf, std::span<const float> factors);

  /// Place of a position of a node.
  [[nodiscard]] TreePlace place(std::uint32_t number, std::size_t index) const {
    return place(number, positions_->of(nodes_[number].of)[index]);
  }
  /// Place of its home, which all nodes that share it touch; see NodePositions.
  [[nodiscard]] TreePlace home(std::uint32_t number, std::size_t index) const {
    return place(number, positions_->homes()[index]);
  }
  /// That place in pixels.
  [[nodiscard]] BlockGrid::Point point(const TreePlace& place) const;
  /// The area of a node in pixels.
  [[nodiscard]] double area(std::uint32_t number) const;
  /// Calls visit(leaf, position) for each leaf that touches a place, with its position there.
  template <class Visit>
  void visit_touching(const TreePlace& place, Visit&& visit) const;

  /// Calls visit(block) for each of the up to eight blocks around a block.
  template <class Visit>
  void visit_blocks_around(std::uint32_t block, Visit&& visit) const;

  /// What the next sample of a leaf is expected to be; 0 without any.
  [[nodiscard]] float prediction(std::uint32_t leaf, std::size_t channel) const;
  /// Makes room for the next sample of a leaf that is not complete, so that absorb() cannot fail.
  /// \throws std::bad_alloc, and what is known is as it was.
  void reserve_next(std::uint32_t leaf);
  /// Takes in the next sample of a leaf that is not complete, one usable value per channel.
  /// \throws std::bad_alloc, and it is as it was.
  void absorb(std::uint32_t leaf, const float* values);
  /// Takes in all of a leaf's next samples that are known. \return how many
  /// \throws std::bad_alloc between two of them; called again it goes on.
  std::size_t advance(std::uint32_t leaf);
  /// Lets a leaf that has had its samples go on as one. `limit` is more than it has.
  void raise_limit(std::uint32_t leaf, std::size_t limit) {
    nodes_[leaf].limit = static_cast<std::uint16_t>(limit);
  }
  /// Splits a leaf that has had 81, 289 or 1089 samples into four and gives them what is theirs of
  /// these, which advance() lets them take in. What the leaf was told is forgotten.
  /// \param limit  of the quadrants
  /// \throws std::bad_alloc, and it is a leaf still.
  void split(std::uint32_t leaf, std::size_t limit);

 private:
  [[nodiscard]] bool has(const TreeNode& node, std::uint32_t index) const {
    if (index < node.samples) return true;
    return index < corners ? ((node.held_corners >> index) & 1) != 0 : index < node.held;
  }
  friend struct TreeArchive;

  [[nodiscard]] TreePlace place(std::uint32_t number, const NodePosition& position) const;
  bool find_next(std::uint32_t leaf);
  std::uint32_t add_quadrants(std::uint32_t parent);
  void hand_down(std::uint32_t parent, std::size_t quadrant, std::size_t count);
  void reserve_quadrants(std::size_t count, std::array<NodeStore::Chunk, 4>& chunks);
  [[nodiscard]] bool is_handed_down(const TreeNode& parent, std::size_t quadrant,
                                    std::size_t index) const;
  void keep_for_others(std::uint32_t parent, std::size_t index);
  void set_scale(std::uint32_t leaf);
  [[nodiscard]] static std::uint64_t key(const TreePlace& place) {
    return (static_cast<std::uint64_t>(place.y) << 32) | static_cast<std::uint64_t>(place.x);
  }

  BlockGrid grid_;
  const NodePositions* positions_;
  KrigingRefiner refiner_;
  NodeStore store_;
  std::vector<TreeNode> nodes_;
  std::vector<float> found_;  // values of a sample
  // Samples on the border of blocks that no leaf of their block has a place for any more: where
  // their values begin in `kept_values_`.
  std::unordered_map<std::uint64_t, std::size_t> kept_;
  std::vector<float> kept_values_;
  std::uint64_t absorbed_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

template <class Visit>
void NodeTree::visit_touching(const TreePlace& place, Visit&& visit) const {
  constexpr std::int64_t edge = NodePositions::edge;
  std::array<std::uint32_t, 4> seen{};
  std::size_t count = 0;
  for (int corner = 0; corner < 4; ++corner) {
    // A little to each side, in halves of a step.
    const std::int64_t x = 2 * place.x + (corner % 2 == 0 ? -1 : 1);
    const std::int64_t y = 2 * place.y + (corner / 2 == 0 ? -1 : 1);
    if (x < 0 || y < 0) continue;
    const auto column = static_cast<std::size_t>(x / (2 * edge));
    const auto row = static_cast<std::size_t>(y / (2 * edge));
    if (column >= grid_.blocks_x || row >= grid_.blocks_y) continue;
    auto number = static_cast<std::uint32_t>(row * grid_.blocks_x + column);
    std::int64_t half = edge;
    std::int64_t left = x % (2 * edge), top = y % (2 * edge);
    while (!nodes_[number].leaf()) {
      const bool right = left >= half, below = top >= half;
      number = nodes_[number].quadrants + (right ? 1u : 0u) + (below ? 2u : 0u);
      left -= right ? half : 0;
      top -= below ? half : 0;
      half /= 2;
    }
    bool known = false;
    for (std::size_t i = 0; i < count; ++i) known = known || seen[i] == number;
    if (known) continue;
    seen[count++] = number;
    const TreeNode& node = nodes_[number];
    const auto local = [&](std::int64_t at, std::size_t block, std::uint16_t of) {
      const std::int64_t in_block = at - static_cast<std::int64_t>(block) * edge;
      return static_cast<std::int32_t>((in_block << node.depth) - std::int64_t{of} * edge);
    };
    visit(number, NodePosition{local(place.x, column, node.column), local(place.y, row, node.row)});
  }
}

template <class Visit>
void NodeTree::visit_blocks_around(std::uint32_t block, Visit&& visit) const {
  const std::size_t x = grid_.column(block), y = grid_.row(block);
  const std::size_t right = std::min(x + 1, grid_.blocks_x - 1);
  const std::size_t below = std::min(y + 1, grid_.blocks_y - 1);
  for (std::size_t row = y > 0 ? y - 1 : 0; row <= below; ++row) {
    for (std::size_t column = x > 0 ? x - 1 : 0; column <= right; ++column) {
      const auto other = static_cast<std::uint32_t>(row * grid_.blocks_x + column);
      if (other != block) visit(other);
    }
  }
}

}  // namespace freqsynth

#include "freqsynth/engine/node_tree.inl"
