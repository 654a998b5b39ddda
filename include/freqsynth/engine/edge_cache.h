// SPDX-License-Identifier: MIT
/// \file
/// The cache of border samples (paper, section 4.3.1): values on the border between blocks that
/// wait until the neighbour's sequence reaches their index.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// Values known for blocks that have not reached them. Both blocks of an edge take its points in
/// the same order (SequencePosition::rank), so an edge needs a first-in first-out list only; a
/// corner of the grid holds one value, which stays for all four blocks.
class EdgeCache {
 public:
  /// Nothing is known yet.
  EdgeCache(const BlockGrid& grid, std::size_t channels);

  /// Makes room, so that the next `more` calls of put() cannot fail.
  void reserve(std::size_t more);

  /// Keeps the values of the point that is `position` for block (block_x, block_y), which will take
  /// it later. On a side, points must come in the order of their ranks; a corner may come again.
  void put(std::size_t block_x, std::size_t block_y, const SequencePosition& position,
           std::span<const float> values);

  /// Values (one per channel) of the point that is `position` for the block if they are known, else
  /// null. Valid until the next put(). The block must consume the values: on a side they are
  /// removed.
  const float* take(std::size_t block_x, std::size_t block_y, const SequencePosition& position);

  /// Number of values on edges that wait.
  [[nodiscard]] std::size_t waiting() const { return waiting_; }

 private:
  friend struct StateArchive;

  static constexpr std::uint32_t none = 0xffffffffu;
  struct Edge {
    std::uint32_t head = none, tail = none;
    std::uint32_t rank = 0;  // of the head
  };

  Edge& edge_at(std::size_t block_x, std::size_t block_y, BlockSide side);
  std::size_t corner_at(std::size_t block_x, std::size_t block_y, const SequencePosition& p) const;

  std::size_t blocks_x_, channels_;
  // Two per block: its left and its top one. Those on the image's right and bottom border have no
  // neighbour, and no place here.
  std::vector<Edge> edges_;
  std::vector<float> corner_values_;
  std::vector<std::uint8_t> corner_known_;
  std::vector<float> pool_;          // values of the waiting points, `channels` each
  std::vector<std::uint32_t> next_;  // next point on the same edge, or next free place
  std::uint32_t free_ = none;
  std::size_t waiting_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

inline EdgeCache::EdgeCache(const BlockGrid& grid, std::size_t channels)
    : blocks_x_(grid.blocks_x),
      channels_(channels),
      edges_(2 * grid.blocks_x * grid.blocks_y),
      corner_values_((grid.blocks_x + 1) * (grid.blocks_y + 1) * channels),
      corner_known_((grid.blocks_x + 1) * (grid.blocks_y + 1)) {}

inline void EdgeCache::reserve(std::size_t more) {
  const std::size_t free_places = next_.size() - waiting_;
  const std::size_t needed = next_.size() + (more > free_places ? more - free_places : 0);
  if (needed > next_.capacity()) next_.reserve(std::max(needed, 2 * next_.capacity()));
  if (needed * channels_ > pool_.capacity()) {
    pool_.reserve(std::max(needed * channels_, 2 * pool_.capacity()));
  }
}

inline EdgeCache::Edge& EdgeCache::edge_at(std::size_t block_x, std::size_t block_y,
                                           BlockSide side) {
  if (side == BlockSide::right) ++block_x;
  if (side == BlockSide::bottom) ++block_y;
  const bool horizontal = side == BlockSide::top || side == BlockSide::bottom;
  return edges_[2 * (block_y * blocks_x_ + block_x) + (horizontal ? 1 : 0)];
}

inline std::size_t EdgeCache::corner_at(std::size_t block_x, std::size_t block_y,
                                        const SequencePosition& p) const {
  return (block_y + (p.t == 1)) * (blocks_x_ + 1) + block_x + (p.s == 1);
}

inline void EdgeCache::put(std::size_t block_x, std::size_t block_y,
                           const SequencePosition& position, std::span<const float> values) {
  FREQSYNTH_ASSERT(position.side != BlockSide::interior && values.size() == channels_);
  if (position.side == BlockSide::corner) {
    const std::size_t corner = corner_at(block_x, block_y, position);
    for (std::size_t c = 0; c < channels_; ++c) corner_values_[corner * channels_ + c] = values[c];
    corner_known_[corner] = 1;
    return;
  }
  std::uint32_t place = free_;
  if (place == none) {
    place = static_cast<std::uint32_t>(next_.size());
    next_.push_back(none);
    pool_.resize(pool_.size() + channels_);
  } else {
    free_ = next_[place];
  }
  next_[place] = none;
  for (std::size_t c = 0; c < channels_; ++c) pool_[place * channels_ + c] = values[c];
  Edge& edge = edge_at(block_x, block_y, position.side);
  if (edge.head == none) {
    edge.head = place;
    edge.rank = position.rank;
  } else {
    next_[edge.tail] = place;
  }
  edge.tail = place;
  ++waiting_;
}

inline const float* EdgeCache::take(std::size_t block_x, std::size_t block_y,
                                    const SequencePosition& position) {
  if (position.side == BlockSide::interior) return nullptr;
  if (position.side == BlockSide::corner) {
    const std::size_t corner = corner_at(block_x, block_y, position);
    return corner_known_[corner] != 0 ? corner_values_.data() + corner * channels_ : nullptr;
  }
  const bool image_border =
      (position.side == BlockSide::right && block_x + 1 == blocks_x_) ||
      (position.side == BlockSide::bottom && 2 * (block_y + 1) * blocks_x_ == edges_.size());
  if (image_border) return nullptr;
  Edge& edge = edge_at(block_x, block_y, position.side);
  if (edge.head == none || edge.rank != position.rank) return nullptr;
  const std::uint32_t place = edge.head;
  edge.head = next_[place];
  ++edge.rank;
  next_[place] = free_;
  free_ = place;
  --waiting_;
  return pool_.data() + std::size_t{place} * channels_;
}

}  // namespace freqsynth
