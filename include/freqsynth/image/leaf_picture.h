// SPDX-License-Identifier: MIT
/// \file
/// A picture from numbers that leaves of a tree have for their pixels and for those around:
/// where several leaves have one for a pixel they are blended.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/rounding.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/engine/throwing_tasks.h"
#include "freqsynth/image/ring_samples.h"

namespace freqsynth::detail {

/// The numbers of a leaf.
struct LeafNumbers {
  /// For each channel rows of side + 2 margin numbers, for as many rows, where `side` is
  /// NodePositions::pixels() of its class: its own parts and `margin` more around.
  const float* numbers = nullptr;
  /// How much each is to be doubted, > 0; null: all the same.
  const float* doubts = nullptr;
  std::size_t margin = 0;
};

/// The leaves of each row of blocks, in the order of the tree.
struct LeafRows {
  std::vector<std::size_t> begins;  ///< of each row, and the end
  std::vector<std::uint32_t> leaves;

  explicit LeafRows(const NodeTree& tree) : begins(tree.grid().blocks_y + 1) {
    const auto row = [&](std::uint32_t leaf) { return tree.grid().row(tree.node(leaf).block); };
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      if (tree.node(i).leaf()) ++begins[row(i) + 1];
    }
    for (std::size_t r = 1; r < begins.size(); ++r) begins[r] += begins[r - 1];
    leaves.resize(begins.back());
    std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      if (tree.node(i).leaf()) leaves[next[row(i)]++] = i;
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t row) const {
    return std::span(leaves).subspan(begins[row], begins[row + 1] - begins[row]);
  }
};

/// Some rows of pixels in the making: those of a row of blocks.
class LeafPicture {
 public:
  LeafPicture(const NodeTree& tree, std::size_t row, std::size_t channels)
      : tree_(tree),
        grid_(tree.grid()),
        channels_(channels),
        top_(row * block_size),
        height_(block_length(row, grid_.height)),
        sums_(height_ * grid_.width * channels),
        weights_(height_ * grid_.width),
        margins_(height_ * grid_.width) {}

  /// Whether a leaf is of a block of 8 x 8 pixels: then its parts are pixels, or lie within one.
  [[nodiscard]] bool whole(std::uint32_t leaf) const {
    const std::size_t block = tree_.node(leaf).block;
    return grid_.block_width(block) == block_size && grid_.block_height(block) == block_size;
  }
  /// Says how far around itself a leaf of this row has numbers. Others are blended into its pixels
  /// as far, and no farther.
  void set_margin(std::uint32_t leaf, std::size_t margin);
  /// Adds a leaf of this row or of one beside it. All leaves of this row have their margin by now.
  void add(std::uint32_t leaf, const LeafNumbers& leaf_numbers);
  /// Writes the rows of the whole picture that these are.
  void store(std::span<float> picture) const;

 private:
  /// A whole leaf in pixels.
  struct Square {
    std::ptrdiff_t x, y;
    std::size_t side;
    double area;  // of each of its parts
  };
  [[nodiscard]] Square square_of(std::uint32_t leaf) const;
  void add_whole(std::uint32_t leaf, const LeafNumbers& leaf_numbers);
  void add_by_area(std::uint32_t leaf, const LeafNumbers& leaf_numbers);

  const NodeTree& tree_;
  const BlockGrid& grid_;
  std::size_t channels_, top_, height_;
  std::vector<double> sums_, weights_;
  std::vector<std::uint8_t> margins_;  // of the leaf that each pixel belongs to
};

/// The picture, channels interleaved, row by row. The same bits for any executor.
/// \param margin   margin(leaf)
/// \param numbers  numbers(leaf, scratch) returns LeafNumbers; `scratch`, a std::vector<float>, may
///                 hold them until the next call with the same one. Called from any thread
template <class Margin, class Numbers>
[[nodiscard]] std::vector<float> blend_leaves(const NodeTree& tree, std::size_t channels,
                                              const ExecutorRef& executor, const Margin& margin,
                                              const Numbers& numbers) {
  const BlockGrid& grid = tree.grid();
  const LeafRows rows(tree);
  std::vector<float> picture(grid.width * grid.height * channels);
  const auto task = [&](std::size_t row) {
    std::vector<float> scratch;
    LeafPicture part(tree, row, channels);
    for (const std::uint32_t leaf : rows.of(row)) part.set_margin(leaf, margin(leaf));
    const std::size_t end = std::min(row + 2, grid.blocks_y);
    for (std::size_t other = row > 0 ? row - 1 : 0; other < end; ++other) {
      for (const std::uint32_t leaf : rows.of(other)) {
        if (other != row && (margin(leaf) == 0 || !part.whole(leaf))) continue;
        part.add(leaf, numbers(leaf, scratch));
      }
    }
    part.store(picture);
  };
  execute_all(executor, grid.blocks_y, task);
  return picture;
}

}  // namespace freqsynth::detail

#include "freqsynth/image/leaf_picture.inl"
