// SPDX-License-Identifier: MIT
/// \file
/// Images of a tree of nodes: by its bank of priors, and by the one prior that steers, which is
/// rough but soon done.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/node_pixels.h"
#include "freqsynth/image/pixel_transform.h"
#include "freqsynth/image/tree_pictures.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {

namespace detail {

/// Whether a leaf, or a node, knows a value below zero in a channel.
inline bool any_negative(const NodeTree& tree, std::size_t channel) {
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    if (!tree.node(leaf).leaf() || tree.node(leaf).samples == 0) continue;
    const std::span<const float> values = tree.values(leaf, channel);
    if (std::any_of(values.begin(), values.end(), [](float value) { return value < 0; })) {
      return true;
    }
  }
  return false;
}

/// Pixels of a tree as an image (CoefficientMeaning::pixel_average). A block's samples are those of
/// its leaves, each of which counts those on its borders.
/// \param keep_positive  makes pixels below zero zero in channels without a value below zero
inline FrequencyImage image_of(const NodeTree& tree, std::vector<float> pixels,
                               bool keep_positive) {
  const BlockGrid& grid = tree.grid();
  const std::size_t channels = tree.channels();
  std::vector<bool> positive(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    positive[c] = keep_positive && !any_negative(tree, c);
    if (!positive[c]) continue;
    for (std::size_t i = c; i < pixels.size(); i += channels) pixels[i] = std::max(pixels[i], 0.0f);
  }
  FrequencyImage image = transform_pixels(pixels, grid.width, grid.height, channels);
  for (std::size_t c = 0; c < channels; ++c) image.set_non_negative(c, positive[c]);
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const TreeNode& node = tree.node(leaf);
    if (!node.leaf()) continue;
    image.samples(grid.column(node.block), grid.row(node.block)) += node.samples;
  }
  return image;
}

/// Squared error that the prior that steers expects of each part of a leaf, in a channel; infinite
/// without a sample.
inline double expected_square(const NodeTree& tree, std::uint32_t leaf, std::size_t channel) {
  const TreeNode& node = tree.node(leaf);
  if (node.samples == 0) return std::numeric_limits<double>::infinity();
  const double scale = node.samples > 1 ? double{tree.squares(leaf, channel)} / (node.samples - 1)
                                        : std::numeric_limits<double>::infinity();
  return scale * double{tree.refiner().variance(node.of, node.samples)};
}

}  // namespace detail

/// The image of the prior that steers: a preview (CoefficientMeaning::pixel_average).
/// \throws std::bad_alloc, and what the executor throws.
[[nodiscard]] inline FrequencyImage rough_image(const NodeTree& tree,
                                                detail::ExecutorRef executor = {}) {
  return detail::image_of(tree, rough_pixels(tree, executor), true);
}

/// Expected squared errors of the pixels of a tree, row by row, channels interleaved, by the prior
/// that steers; infinite where a leaf has had fewer than two samples.
[[nodiscard]] inline std::vector<float> rough_squares(const NodeTree& tree,
                                                      detail::ExecutorRef executor = {}) {
  return node_pixels(tree, executor,
                     [&](std::uint32_t leaf, std::size_t channel, std::span<float> parts) {
                       // Of leaves smaller than a pixel each has its share of the error, whose
                       // square counts.
                       const double share = std::min(1.0, tree.area(leaf));
                       const double square = share * detail::expected_square(tree, leaf, channel);
                       std::fill(parts.begin(), parts.end(), static_cast<float>(square));
                     });
}

/// Makes images of trees by a bank of priors; its lists, and what it knows of leaves, stay for the
/// next one. For any threads: one waits for another.
class TreeImages {
 public:
  /// \param positions  of the trees' nodes; must live as long as this
  explicit TreeImages(const NodePositions& positions) : positions_(&positions) {}

  /// Pixels of the bank (CoefficientMeaning::pixel_average).
  /// \param noisy          whether values are Monte Carlo estimates
  /// \param keep_positive  see FinishSettings::keep_positive
  /// \throws std::bad_alloc, and what the executor throws.
  [[nodiscard]] FrequencyImage image(const NodeTree& tree, bool noisy, bool keep_positive,
                                     detail::ExecutorRef executor = {}) {
    const std::lock_guard lock(mutex_);
    return detail::image_of(tree, pictures(noisy).pixels(tree, executor), keep_positive);
  }

  /// Expected squared errors of these pixels, row by row, channels interleaved: those of the bank,
  /// shared out among channels as the prior that steers has it. Infinite where a leaf has had fewer
  /// than two samples. \throws std::bad_alloc.
  [[nodiscard]] std::vector<float> expected_squares(const NodeTree& tree, bool noisy) {
    const std::lock_guard lock(mutex_);
    const std::vector<float> means = pictures(noisy).errors(tree);
    std::vector<float> squares = rough_squares(tree);
    const std::size_t channels = tree.channels();
    for (std::size_t pixel = 0; pixel < means.size(); ++pixel) {
      const auto own = std::span(squares).subspan(pixel * channels, channels);
      double sum = 0;
      for (const float square : own) sum += double{square};
      if (!detail::is_finite(sum)) continue;
      const double all = static_cast<double>(channels) * double{means[pixel]};
      for (float& square : own) {
        const double share = sum > 0 ? double{square} / sum : 1 / static_cast<double>(channels);
        square = static_cast<float>(all * share);
      }
    }
    return squares;
  }

 private:
  /// Those of exact values, or of estimates.
  TreePictures& pictures(bool noisy) {
    std::unique_ptr<TreePictures>& one = pictures_[noisy ? 1 : 0];
    if (one == nullptr) {
      one = std::make_unique<TreePictures>(*positions_,
                                           noisy ? PriorBank::noisy() : PriorBank::exact());
    }
    return *one;
  }

  const NodePositions* positions_;
  std::mutex mutex_;
  std::array<std::unique_ptr<TreePictures>, 2> pictures_;
};

}  // namespace freqsynth
