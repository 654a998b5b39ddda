// SPDX-License-Identifier: MIT
/// \file
/// The queue of blocks (paper, section 4.4, where it is a sorted linked list): here a tournament
/// over a fixed set of players, so that any block's priority can change at any time.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// All blocks with their priorities. The block with the highest one is first; among equal ones, the
/// lowest number. Changing one priority and finding the first cost O(log n).
class BlockQueue {
 public:
  /// Priority of a block that is out of the queue: below every other.
  static constexpr float absent = std::numeric_limits<float>::lowest();

  /// `blocks` blocks, all absent.
  explicit BlockQueue(std::size_t blocks = 0);

  /// Number of blocks, absent ones included.
  [[nodiscard]] std::size_t size() const { return blocks_; }
  /// Priority of a block; `absent` when it is out.
  [[nodiscard]] float priority(std::size_t block) const { return levels_.front()[block]; }
  /// Highest priority; `absent` when no block is in the queue.
  [[nodiscard]] float top_priority() const { return levels_.back().front(); }
  /// The block that is first. At least one block exists.
  [[nodiscard]] std::size_t top() const;

  /// Makes it a queue of so many blocks, at least as many as it has; new ones are absent. What it
  /// had stays. \throws std::bad_alloc, and nothing has changed.
  void grow(std::size_t blocks);

  /// Sets the priority of a block; `absent` takes it out. Not a NaN.
  void update(std::size_t block, float priority);

 private:
  static constexpr std::size_t arity = 8;

  std::size_t blocks_;
  // levels_[0] holds the priorities, padded to whole groups; each later level the maximum of each
  // group.
  std::vector<std::vector<float>> levels_;
};

// ------------------------------------------------------------------------------------ definitions

inline BlockQueue::BlockQueue(std::size_t blocks) : blocks_(blocks) {
  std::size_t count = std::max<std::size_t>(blocks, 1);
  do {
    const std::size_t groups = (count + arity - 1) / arity;
    levels_.emplace_back(groups * arity, absent);
    count = groups;
  } while (count > 1);
  levels_.emplace_back(1, absent);
}

inline void BlockQueue::grow(std::size_t blocks) {
  FREQSYNTH_ASSERT(blocks >= blocks_);
  if (blocks <= levels_.front().size()) {
    blocks_ = blocks;
    return;
  }
  // Twice as many, so that each is copied a few times only.
  BlockQueue larger(std::max(blocks, 2 * blocks_));
  for (std::size_t block = 0; block < blocks_; ++block) larger.update(block, priority(block));
  larger.blocks_ = blocks;
  *this = std::move(larger);
}

inline std::size_t BlockQueue::top() const {
  std::size_t place = 0;
  for (std::size_t level = levels_.size() - 1; level > 0; --level) {
    const float best = levels_[level][place];
    const float* group = levels_[level - 1].data() + place * arity;
    // Without branches, for which member wins cannot be foretold.
    unsigned winners = 0;
    for (std::size_t i = 0; i < arity; ++i) winners |= (group[i] == best ? 1u : 0u) << i;
    place = place * arity + static_cast<std::size_t>(std::countr_zero(winners));
  }
  return place;
}

inline void BlockQueue::update(std::size_t block, float priority) {
  FREQSYNTH_ASSERT(block < blocks_ && priority == priority);
  levels_[0][block] = priority;
  std::size_t place = block;
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    place /= arity;
    const float* group = levels_[level - 1].data() + place * arity;
    float best = group[0];
    for (std::size_t i = 1; i < arity; ++i) best = group[i] > best ? group[i] : best;
    float& known = levels_[level][place];
    if (known == best) return;  // nothing changes further up
    known = best;
  }
}

}  // namespace freqsynth
