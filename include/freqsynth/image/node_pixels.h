// SPDX-License-Identifier: MIT
/// \file
/// A picture from the leaves of a tree: each pixel the mean of what lies in it, by area.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/node_tree.h"

namespace freqsynth {

/// What the covariance that steers makes of a leaf: the averages of its parts,
/// NodePositions::pixels of its class squared, row by row. Of a leaf that waits, the mean of what
/// it knows. Zeros without a sample.
inline void rough_averages(const NodeTree& tree, std::uint32_t leaf, std::size_t channel,
                           std::span<float> averages) {
  const TreeNode& node = tree.node(leaf);
  if (node.samples == 0 || tree.waits(leaf)) {
    std::fill(averages.begin(), averages.end(), tree.known_mean(leaf, channel));
    return;
  }
  std::fill(averages.begin(), averages.end(), 0.0f);
  const std::span<const float> innovations = tree.innovations(leaf, channel);
  const InnovationList& list = tree.refiner().list(node.of);
  for (std::size_t i = 1; i < innovations.size(); ++i) {
    const std::span<const float> gains = list.row(i).gains;
    for (std::size_t p = 0; p < averages.size(); ++p) averages[p] += gains[p] * innovations[i];
  }
  for (float& average : averages) average += tree.values(leaf, channel).front();
}

namespace detail {

/// What a part from one place to another has of the pixels along an axis.
struct PixelRun {
  double from = 0, to = 0;  ///< pixels

  /// The first pixel that it has some of.
  [[nodiscard]] std::size_t first() const { return static_cast<std::size_t>(from); }
  /// The number after the last.
  [[nodiscard]] std::size_t end() const {
    return std::max(first() + 1, static_cast<std::size_t>(std::ceil(to)));
  }
  /// How much of a pixel it has.
  [[nodiscard]] double share(std::size_t pixel) const {
    const auto at = static_cast<double>(pixel);
    return std::max(0.0, std::min(to, at + 1) - std::max(from, at));
  }
};

}  // namespace detail

/// The pixels of a tree's image, channels interleaved, row by row.
///
/// Where a block is 8 pixels wide and high, parts of leaves are pixels, or lie within one. In the
/// narrower last ones pixels are made of parts that are taken to be constant.
/// \param averages  averages(leaf, channel, out) writes those of the parts of a leaf, row by row
template <class Averages>
[[nodiscard]] std::vector<float> node_pixels(const NodeTree& tree, Averages&& averages) {
  const BlockGrid& grid = tree.grid();
  const std::size_t channels = tree.channels();
  std::vector<double> sums(grid.width * grid.height * channels);
  std::vector<float> parts;
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const TreeNode& node = tree.node(leaf);
    if (!node.leaf()) continue;
    const std::size_t side = tree.positions().pixels(node.of);
    parts.resize(side * side);
    const auto run = [&](std::size_t block, std::size_t pixels, std::uint16_t of,
                         std::size_t part) {
      const double edge = static_cast<double>(pixels) / std::ldexp(1.0, node.depth);
      const auto begin = static_cast<double>(block * block_size) + edge * of;
      const double step = edge / static_cast<double>(side);
      const auto at = static_cast<double>(part);
      return detail::PixelRun{begin + step * at, begin + step * (at + 1)};
    };
    for (std::size_t c = 0; c < channels; ++c) {
      averages(leaf, c, std::span<float>(parts));
      for (std::size_t part = 0; part < parts.size(); ++part) {
        const detail::PixelRun rows =
            run(grid.row(node.block), grid.block_height(node.block), node.row, part / side);
        const detail::PixelRun columns =
            run(grid.column(node.block), grid.block_width(node.block), node.column, part % side);
        for (std::size_t y = rows.first(); y < std::min(rows.end(), grid.height); ++y) {
          for (std::size_t x = columns.first(); x < std::min(columns.end(), grid.width); ++x) {
            sums[(y * grid.width + x) * channels + c] +=
                double{parts[part]} * rows.share(y) * columns.share(x);
          }
        }
      }
    }
  }
  return {sums.begin(), sums.end()};
}

}  // namespace freqsynth
