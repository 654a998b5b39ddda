// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "freqsynth/image/constant_pixels.h"

namespace freqsynth::detail {

template <class Task>
void ConstantPixels::each_block(const ExecutorRef& executor, Task&& task) const {
  const std::size_t columns = tree_.grid().blocks_x;
  execute_all(executor, tree_.grid().blocks_y, [&](std::size_t row) {
    for (std::size_t block = row * columns; block < (row + 1) * columns; ++block) task(block);
  });
}

inline ConstantPixels::ConstantPixels(const NodeTree& tree, const ExecutorRef& executor)
    : tree_(tree),
      means_(tree.grid().width * tree.grid().height * tree.channels()),
      counts_(means_.size()),
      agreements_(tree.grid().size() * tree.channels()),
      pairs_(agreements_.size()) {
  each_block(executor, [&](std::size_t block) {
    for (std::size_t c = 0; c < tree_.channels(); ++c) look_at(block, c);
  });
  each_block(executor, [&](std::size_t block) {
    for (std::size_t c = 0; c < tree_.channels(); ++c) count_pairs(block, c);
  });
  for (std::size_t i = 0; i < pairs_.size(); ++i) agreements_[i].pairs = pairs_[i];
}

inline ConstantPixels::Part ConstantPixels::part(std::size_t block) const {
  const BlockGrid& grid = tree_.grid();
  const std::size_t left = grid.column(block) * block_size, top = grid.row(block) * block_size;
  return {left, top, left + grid.block_width(block), top + grid.block_height(block)};
}

/// Finds what the samples of a block show.
inline void ConstantPixels::look_at(std::size_t block, std::size_t channel) {
  const Part own = part(block);
  std::array<double, max_terms> sums{};
  std::array<float, max_terms> low{}, high{};
  std::array<std::uint32_t, max_terms> counts{};
  std::vector<std::uint32_t> nodes{static_cast<std::uint32_t>(block)};
  while (!nodes.empty()) {
    const std::uint32_t number = nodes.back();
    nodes.pop_back();
    const TreeNode& node = tree_.node(number);
    for (std::uint32_t k = 0; k < 4 && !node.leaf(); ++k) nodes.push_back(node.quadrants + k);
    if (!node.leaf()) continue;
    tree_.visit_known(number, channel, [&](std::uint32_t index, float value) {
      const BlockGrid::Point point = tree_.point(tree_.place(number, index));
      const double x = point.x - static_cast<double>(own.left);
      const double y = point.y - static_cast<double>(own.top);
      const double column = std::floor(x), row = std::floor(y);
      if (column == x || row == y) return;
      // The first samples of a node may lie beyond its border, but not beyond that of its block.
      const std::size_t pixel =
          static_cast<std::size_t>(row) * block_size + static_cast<std::size_t>(column);
      low[pixel] = counts[pixel] > 0 ? std::min(low[pixel], value) : value;
      high[pixel] = counts[pixel] > 0 ? std::max(high[pixel], value) : value;
      sums[pixel] += double{value};
      ++counts[pixel];
    });
  }
  PixelAgreement& agreement = agreements_[block * tree_.channels() + channel];
  for (std::size_t y = own.top; y < own.bottom; ++y) {
    for (std::size_t x = own.left; x < own.right; ++x) {
      const std::size_t pixel = (y - own.top) * block_size + x - own.left;
      if (counts[pixel] == 0) continue;
      const auto mean = static_cast<float>(sums[pixel] / counts[pixel]);
      means_[at(x, y, channel)] = mean;
      counts_[at(x, y, channel)] = counts[pixel];
      agreement.low = std::min(agreement.low, mean);
      agreement.high = std::max(agreement.high, mean);
      agreement.spread = std::max(agreement.spread, high[pixel] - low[pixel]);
    }
  }
}

/// Of a block and those around it.
inline PixelAgreement ConstantPixels::around(std::size_t block, std::size_t channel) const {
  PixelAgreement all = agreements_[block * tree_.channels() + channel];
  tree_.visit_blocks_around(static_cast<std::uint32_t>(block), [&](std::uint32_t other) {
    all.join(agreements_[other * tree_.channels() + channel]);
  });
  return all;
}

/// What the pixels up to `reach` from one show, as far as they lie in a part; itself included.
inline PixelAgreement ConstantPixels::beside(const Part& part, std::size_t x, std::size_t y,
                                             std::size_t channel, std::size_t reach) const {
  PixelAgreement all;
  for (std::size_t j = std::max(y, part.top + reach) - reach;
       j < std::min(y + reach + 1, part.bottom); ++j) {
    for (std::size_t i = std::max(x, part.left + reach) - reach;
         i < std::min(x + reach + 1, part.right); ++i) {
      const std::size_t other = at(i, j, channel);
      if (counts_[other] == 0) continue;
      all.low = std::min(all.low, means_[other]);
      all.high = std::max(all.high, means_[other]);
    }
  }
  return all;
}

inline void ConstantPixels::count_pairs(std::size_t block, std::size_t channel) {
  constexpr float something = 0.02f;  // of the range
  const PixelAgreement known = around(block, channel);
  const float least = something * (known.high - known.low);
  const Part own = part(block), all{0, 0, tree_.grid().width, tree_.grid().height};
  for (std::size_t y = own.top; y < own.bottom; ++y) {
    for (std::size_t x = own.left; x < own.right; ++x) {
      if (counts_[at(x, y, channel)] < 2) continue;
      const PixelAgreement others = beside(all, x, y, channel, 2);
      pairs_[block * tree_.channels() + channel] += others.high - others.low > least ? 1 : 0;
    }
  }
}

inline void ConstantPixels::set_pixels(std::span<float> pixels, const ExecutorRef& executor) const {
  each_block(executor, [&](std::size_t block) {
    for (std::size_t c = 0; c < tree_.channels(); ++c) {
      if (!around(block, c).holds()) continue;
      const Part own = part(block);
      for (std::size_t y = own.top; y < own.bottom; ++y) {
        for (std::size_t x = own.left; x < own.right; ++x) {
          const std::size_t pixel = at(x, y, c);
          if (counts_[pixel] > 0) {
            pixels[pixel] = means_[pixel];
            continue;
          }
          // Beyond the border of the block an edge may lie.
          const PixelAgreement known = beside(own, x, y, c, 1);
          if (known.low > known.high) continue;
          pixels[pixel] = std::clamp(pixels[pixel], known.low, known.high);
        }
      }
    }
  });
}

inline void ConstantPixels::lower_errors(std::span<float> errors,
                                         const ExecutorRef& executor) const {
  const std::size_t channels = tree_.channels();
  each_block(executor, [&](std::size_t block) {
    double most = 0;
    bool constant = true;
    for (std::size_t c = 0; c < channels; ++c) {
      const PixelAgreement agreement = around(block, c);
      constant = constant && agreement.holds();
      const double half = (double{agreement.high} - double{agreement.low}) / 2;
      most += half * half / (agreement.pairs + 1.0);
    }
    if (!constant) return;
    const auto bound = static_cast<float>(most / static_cast<double>(channels));
    const Part own = part(block);
    for (std::size_t y = own.top; y < own.bottom; ++y) {
      for (std::size_t x = own.left; x < own.right; ++x) {
        float& error = errors[y * tree_.grid().width + x];
        if (counts_[at(x, y, 0)] > 0) error = std::min(error, bound);
      }
    }
  });
}

}  // namespace freqsynth::detail
