// SPDX-License-Identifier: MIT
/// \file
/// A picture from the leaves of a tree: each pixel the mean of what lies in it, by area.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/image/leaf_picture.h"

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

/// The pixels of a tree's image, channels interleaved, row by row.
///
/// Where a block is 8 pixels wide and high, parts of leaves are pixels, or lie within one. In the
/// narrower last ones pixels are made of parts that are taken to be constant.
/// \param executor  runs rows of blocks; the pixels do not depend on it
/// \param averages  averages(leaf, channel, out) writes those of the parts of a leaf, row by row;
///                  is called from the executor's threads
template <Executor E, class Averages>
[[nodiscard]] std::vector<float> node_pixels(const NodeTree& tree, E& executor,
                                             const Averages& averages) {
  const auto numbers = [&](std::uint32_t leaf, std::vector<float>& scratch) {
    const std::size_t side = tree.positions().pixels(tree.node(leaf).of);
    scratch.resize(tree.channels() * side * side);
    for (std::size_t c = 0; c < tree.channels(); ++c) {
      averages(leaf, c, std::span(scratch).subspan(c * side * side, side * side));
    }
    return detail::LeafNumbers{scratch.data(), nullptr, 0};
  };
  return detail::blend_leaves(
      tree, tree.channels(), detail::ExecutorRef(executor),
      [](std::uint32_t) { return std::size_t{0}; }, numbers);
}

/// A rough picture, for a look while samples are taken: what the covariance that steers makes of
/// each leaf alone. It costs a few operations for each sample and pixel of a leaf.
/// \param executor  runs rows of blocks; the pixels do not depend on it
/// \throws std::bad_alloc.
template <Executor E>
[[nodiscard]] std::vector<float> rough_pixels(const NodeTree& tree, E& executor) {
  return node_pixels(tree, executor,
                     [&](std::uint32_t leaf, std::size_t channel, std::span<float> averages) {
                       rough_averages(tree, leaf, channel, averages);
                     });
}

}  // namespace freqsynth
