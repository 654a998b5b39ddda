// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include "freqsynth/engine/node_tree.h"

namespace freqsynth {

// In a chunk: for each channel the sum of squared innovations; then the factors; and as rows, for
// each channel its values and their innovations.
inline NodeTree::NodeTree(const BlockGrid& grid, const NodePositions& positions, std::size_t limit,
                          std::vector<float> weights, double noise)
    : grid_(grid),
      positions_(&positions),
      refiner_(positions, std::move(weights), noise),
      store_(2 * refiner_.channels(), 2 * refiner_.channels()),
      nodes_(grid.size()),
      found_(refiner_.channels()) {
  for (std::uint32_t block = 0; block < nodes_.size(); ++block) {
    nodes_[block].block = block;
    nodes_[block].limit = static_cast<std::uint16_t>(limit);
  }
}

inline NodeTree::NodeTree(const NodeTree& other)
    : grid_(other.grid_),
      positions_(other.positions_),
      refiner_(other.refiner_),
      store_(2 * refiner_.channels(), 2 * refiner_.channels()),
      nodes_(other.nodes_),
      found_(other.found_),
      kept_(other.kept_),
      kept_values_(other.kept_values_),
      absorbed_(other.absorbed_) {
  for (TreeNode& node : nodes_) {
    if (node.chunk) node.chunk = store_.copy(node.chunk);
  }
}

inline double NodeTree::squares(std::uint32_t leaf) const {
  const float* head = nodes_[leaf].chunk.data;
  if (head == nullptr) return 0;
  double sum = 0;
  for (std::size_t c = 0; c < channels(); ++c) {
    sum += double{refiner_.weights()[c]} * double{head[channels() + c]} * double{head[c]};
  }
  return sum;
}

inline float NodeTree::known_mean(std::uint32_t leaf, std::size_t channel) const {
  double sum = 0;
  std::size_t count = 0;
  visit_known(leaf, channel, [&](std::uint32_t, float value) {
    sum += double{value};
    ++count;
  });
  return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
}

inline double NodeTree::known_error(std::uint32_t leaf, std::size_t channel) const {
  const double mean = double{known_mean(leaf, channel)};
  double sum = 0, count = 0;
  visit_known(leaf, channel, [&](std::uint32_t, float value) {
    const double off = double{value} - mean;
    sum += off * off;
    ++count;
  });
  return count > 1 ? sum / (count * (count - 1)) : 0;
}

inline TreePlace NodeTree::place(std::uint32_t number, const NodePosition& position) const {
  const TreeNode& node = nodes_[number];
  const auto steps = [&](std::size_t block, std::uint16_t of, std::int32_t at) {
    const std::int64_t inside = std::int64_t{of} * NodePositions::edge + at;
    FREQSYNTH_ASSERT(inside % (std::int64_t{1} << node.depth) == 0);
    return static_cast<std::int64_t>(block) * NodePositions::edge + (inside >> node.depth);
  };
  return {steps(grid_.column(node.block), node.column, position.s),
          steps(grid_.row(node.block), node.row, position.t)};
}

inline BlockGrid::Point NodeTree::point(const TreePlace& place) const {
  const auto pixels = [](std::int64_t at, std::size_t blocks, std::size_t length) {
    const auto block = std::min(static_cast<std::size_t>(at / NodePositions::edge), blocks - 1);
    const auto inside = at - static_cast<std::int64_t>(block) * NodePositions::edge;
    return static_cast<double>(block * block_size) +
           static_cast<double>(inside) / NodePositions::edge *
               static_cast<double>(detail::block_length(block, length));
  };
  return {pixels(place.x, grid_.blocks_x, grid_.width),
          pixels(place.y, grid_.blocks_y, grid_.height)};
}

inline double NodeTree::area(std::uint32_t number) const {
  const TreeNode& node = nodes_[number];
  const auto pixels =
      static_cast<double>(grid_.block_width(node.block) * grid_.block_height(node.block));
  return pixels / static_cast<double>(std::uint64_t{1} << (2 * node.depth));
}

inline float NodeTree::prediction(std::uint32_t leaf, std::size_t channel) const {
  const TreeNode& node = nodes_[leaf];
  if (node.samples == 0) return 0;
  return values(leaf, channel).front() +
         refiner_.prediction(node.of, node.samples, innovations(leaf, channel).data());
}

inline void NodeTree::reserve_next(std::uint32_t leaf) {
  TreeNode& node = nodes_[leaf];
  FREQSYNTH_ASSERT(node.leaf() && !node.complete());
  const std::size_t index = node.samples;
  static_cast<void>(refiner_.list(node.of).row(index));
  const bool fresh = !node.chunk;
  store_.enlarge(node.chunk, std::max<std::size_t>(index, node.held), index + 1);
  if (fresh) std::fill_n(node.chunk.data + channels(), channels(), 1.0f);
}

inline void NodeTree::absorb(std::uint32_t leaf, const float* values) {
  reserve_next(leaf);
  TreeNode& node = nodes_[leaf];
  const std::size_t index = node.samples;
  const InnovationRow& row = refiner_.list(node.of).row(index);
  for (std::size_t c = 0; c < channels(); ++c) {
    float* known = store_.row(node.chunk, 2 * c);
    float* innovations = store_.row(node.chunk, 2 * c + 1);
    const float value = values[c];
    known[index] = value;
    // The first one tells of the constant alone.
    if (index == 0) continue;
    innovations[index] = innovation_of(row, innovations, value - known[0]);
    node.chunk.data[c] += innovations[index] * innovations[index];
  }
  ++node.samples;
  ++absorbed_;
  set_scale(leaf);
}

inline void NodeTree::set_factors(std::uint32_t leaf, std::span<const float> factors) {
  std::copy(factors.begin(), factors.end(), nodes_[leaf].chunk.data + channels());
  set_scale(leaf);
}

inline void NodeTree::set_scale(std::uint32_t leaf) {
  TreeNode& node = nodes_[leaf];
  if (node.samples < 2) return;
  // Finite, and so are sums of it; below what a saved one may hold when it is rounded, too.
  node.scale = static_cast<float>(std::min(squares(leaf) / (node.samples - 1), 0.99e30));
}

/// Whether the next sample is known; then its values are in `found_`.
inline bool NodeTree::find_next(std::uint32_t leaf) {
  const TreeNode& node = nodes_[leaf];
  const std::uint32_t index = node.samples;
  const auto take = [this](std::uint32_t from, std::uint32_t at) {
    for (std::size_t c = 0; c < channels(); ++c) {
      found_[c] = store_.row(nodes_[from].chunk, 2 * c)[at];
    }
  };
  if (has(node, index)) {
    take(leaf, index);
    return true;
  }
  if (!NodePositions::on_border(positions_->homes()[index])) return false;
  bool found = false;
  const TreePlace wanted = place(leaf, index);
  visit_touching(home(leaf, index), [&](std::uint32_t other, const NodePosition& there) {
    if (found || other == leaf) return;
    const std::uint32_t at = positions_->index_at(there);
    if (at == NodePositions::none || !has(nodes_[other], at)) return;
    // Corners of deeper nodes stay where others have theirs moved.
    if (!(place(other, at) == wanted)) return;
    take(other, at);
    found = true;
  });
  if (found || kept_.empty()) return found;
  const auto kept = kept_.find(key(wanted));
  if (kept == kept_.end()) return false;
  std::copy_n(kept_values_.begin() + static_cast<std::ptrdiff_t>(kept->second), channels(),
              found_.begin());
  return true;
}

inline std::size_t NodeTree::advance(std::uint32_t leaf) {
  std::size_t count = 0;
  for (; !nodes_[leaf].complete() && find_next(leaf); ++count) absorb(leaf, found_.data());
  return count;
}

inline void NodeTree::split(std::uint32_t leaf, std::size_t limit) {
  const std::size_t count = NodePositions::handed_down(nodes_[leaf].samples);
  FREQSYNTH_ASSERT(nodes_[leaf].leaf() && count != 0 && nodes_[leaf].depth < deepest);
  // What is kept for others is known to them from the leaf as well, so long as it is one.
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < corners; ++i) {
      if (!is_handed_down(nodes_[leaf], k, i)) keep_for_others(leaf, positions_->in_parent(k, i));
    }
  }
  std::array<NodeStore::Chunk, 4> chunks;
  reserve_quadrants(count, chunks);
  // From here on nothing fails.
  const std::uint32_t first = add_quadrants(leaf);
  for (std::uint32_t k = 0; k < 4; ++k) {
    nodes_[first + k].limit = static_cast<std::uint16_t>(std::max(limit, count));
    nodes_[first + k].chunk = chunks[k];
    hand_down(leaf, k, count);
  }
  store_.give_back(nodes_[leaf].chunk);
}

/// Takes the memory of four more nodes with so many samples each, all of it or none.
inline void NodeTree::reserve_quadrants(std::size_t count,
                                        std::array<NodeStore::Chunk, 4>& chunks) {
  if (nodes_.capacity() < nodes_.size() + 4) nodes_.reserve(2 * nodes_.size() + 4);
  try {
    for (NodeStore::Chunk& chunk : chunks) chunk = store_.take(count);
  } catch (...) {
    for (NodeStore::Chunk& chunk : chunks) store_.give_back(chunk);
    throw;
  }
}

/// Makes a leaf a parent. Its quadrants, of which the first is returned, have nothing yet.
inline std::uint32_t NodeTree::add_quadrants(std::uint32_t number) {
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  for (std::uint32_t k = 0; k < 4; ++k) {
    const TreeNode& parent = nodes_[number];
    TreeNode quadrant;
    quadrant.block = parent.block;
    quadrant.column = static_cast<std::uint16_t>(2 * parent.column + (k & 1));
    quadrant.row = static_cast<std::uint16_t>(2 * parent.row + (k >> 1));
    quadrant.depth = static_cast<std::uint8_t>(parent.depth + 1);
    quadrant.of = static_cast<std::uint8_t>(positions_->quadrant_class(parent.of, k));
    quadrant.parent = number;
    nodes_.push_back(quadrant);
  }
  nodes_[number].quadrants = first;
  return first;
}

/// Whether sample `index` of a quadrant is one of its parent's. All but corners are.
inline bool NodeTree::is_handed_down(const TreeNode& parent, std::size_t quadrant,
                                     std::size_t index) const {
  const bool same = positions_->same_place(parent.of, quadrant, index);
  FREQSYNTH_ASSERT(same || index < corners);
  return same;
}

/// Gives a quadrant what is its own of its parent's samples; nothing of it is taken in yet.
inline void NodeTree::hand_down(std::uint32_t parent, std::size_t quadrant, std::size_t count) {
  const TreeNode& from = nodes_[parent];
  TreeNode& to = nodes_[from.quadrants + quadrant];
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_handed_down(from, quadrant, i)) continue;
    if (i < corners) to.held_corners = static_cast<std::uint8_t>(to.held_corners | (1u << i));
    for (std::size_t c = 0; c < channels(); ++c) {
      const float* values = store_.row(from.chunk, 2 * c);
      store_.row(to.chunk, 2 * c)[i] = values[positions_->in_parent(quadrant, i)];
    }
  }
  const float* factors = from.chunk.data + channels();
  std::copy(factors, factors + channels(), to.chunk.data + channels());
  to.held = static_cast<std::uint16_t>(count);
}

/// A block beside this one may still come to a sample that the deeper nodes here cannot use.
inline void NodeTree::keep_for_others(std::uint32_t parent, std::size_t index) {
  const TreePlace lattice = home(parent, index), at = place(parent, index);
  if (lattice.x % NodePositions::edge != 0 && lattice.y % NodePositions::edge != 0) return;
  if (kept_.count(key(at)) > 0) return;
  const std::size_t first = kept_values_.size();
  try {
    for (std::size_t c = 0; c < channels(); ++c) {
      kept_values_.push_back(store_.row(nodes_[parent].chunk, 2 * c)[index]);
    }
    kept_.emplace(key(at), first);
  } catch (...) {
    kept_values_.resize(first);
    throw;
  }
}

}  // namespace freqsynth
