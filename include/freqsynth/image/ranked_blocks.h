// SPDX-License-Identifier: MIT
/// \file
/// What values of blocks usually are in the windows around each.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/window_ranks.h"

namespace freqsynth::detail {

/// Values of some blocks of a picture in their order.
class RankedBlocks {
 public:
  /// A value, and the block that has it.
  using Value = std::pair<double, std::uint32_t>;

  /// \param values  of the blocks that have one, in any order
  /// \param blocks  how many there are, row by row
  RankedBlocks(std::vector<Value> values, std::size_t blocks_x, std::size_t blocks);

  /// Of each block of a row the value that the given share of those up to `reach` away along both
  /// axes does not exceed; 0 where none has a value.
  void usual(std::size_t row, std::size_t reach, double share, std::span<double> out) const;

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  std::size_t blocks_x_;
  std::vector<Value> order_;
  std::vector<std::uint32_t> ranks_;  // of each block in the order
};

// ------------------------------------------------------------------------------------ definitions

inline RankedBlocks::RankedBlocks(std::vector<Value> values, std::size_t blocks_x,
                                  std::size_t blocks)
    : blocks_x_(blocks_x), order_(std::move(values)), ranks_(blocks, none) {
  std::sort(order_.begin(), order_.end());
  for (std::size_t rank = 0; rank < order_.size(); ++rank) {
    ranks_[order_[rank].second] = static_cast<std::uint32_t>(rank);
  }
}

inline void RankedBlocks::usual(std::size_t row, std::size_t reach, double share,
                                std::span<double> out) const {
  WindowRanks window(order_.size());
  std::size_t count = 0;
  const std::size_t top = row - std::min(row, reach);
  const std::size_t bottom = std::min(row + reach + 1, ranks_.size() / blocks_x_);
  const auto visit_column = [&](std::size_t x, auto&& visit) {
    for (std::size_t v = top; v < bottom; ++v) {
      const std::uint32_t rank = ranks_[v * blocks_x_ + x];
      if (rank != none) visit(rank);
    }
  };
  const auto add = [&](std::uint32_t rank) {
    window.add(rank);
    ++count;
  };
  const auto remove = [&](std::uint32_t rank) {
    window.remove(rank);
    --count;
  };
  for (std::size_t x = 0; x < std::min(reach, blocks_x_); ++x) visit_column(x, add);
  for (std::size_t x = 0; x < blocks_x_; ++x) {
    if (x + reach < blocks_x_) visit_column(x + reach, add);
    if (x > reach) visit_column(x - reach - 1, remove);
    out[x] = 0;
    if (count == 0) continue;
    const auto place = static_cast<std::size_t>(share * static_cast<double>(count - 1));
    out[x] = order_[window.of_rank(place)].first;
  }
}

}  // namespace freqsynth::detail
