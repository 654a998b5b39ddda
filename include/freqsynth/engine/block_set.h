// SPDX-License-Identifier: MIT
/// \file
/// A set of blocks that is filled and emptied often.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Some of the blocks of an image, in the order in which they were added. All its memory is taken
/// by the constructor.
class BlockSet {
 public:
  /// The empty set of blocks 0 .. blocks - 1.
  explicit BlockSet(std::size_t blocks) : member_(blocks) { order_.reserve(blocks); }

  /// Whether a block is in the set.
  [[nodiscard]] bool contains(std::size_t block) const { return member_[block] != 0; }
  /// Adds a block, unless it is in the set.
  void add(std::uint32_t block) {
    if (member_[block] != 0) return;
    member_[block] = 1;
    order_.push_back(block);
  }
  /// The blocks of the set, in the order in which they were added.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return order_; }
  /// Empties the set, at a cost in proportion to its members.
  void clear() {
    for (const std::uint32_t block : order_) member_[block] = 0;
    order_.clear();
  }

 private:
  std::vector<std::uint8_t> member_;
  std::vector<std::uint32_t> order_;
};

}  // namespace freqsynth
