// SPDX-License-Identifier: MIT
/// \file
/// Pictures of trees that are constant within each pixel; what PixelAgreement says of those of
/// blocks.
///
/// A sample that lies just on the border of two pixels shows one side of an edge there, and no
/// stationary prior knows which: estimates of both sides believe it. Samples within pixels are not
/// deceived. Where all that lie in one pixel are equal, and so are those in the pixels around, a
/// pixel is what its own samples say, and one that has none lies within what those beside it show.
/// Flat parts prove nothing: what counts are pixels with two samples or more beside others that
/// show something else.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/engine/throwing_tasks.h"
#include "freqsynth/image/pixel_agreement.h"

namespace freqsynth::detail {

/// Where the picture of a tree is constant within pixels.
class ConstantPixels {
 public:
  /// Looks at all samples. The same for any executor. \throws std::bad_alloc.
  ConstantPixels(const NodeTree& tree, const ExecutorRef& executor);

  /// Sets what is known of the pixels of a picture, channels interleaved, row by row.
  void set_pixels(std::span<float> pixels, const ExecutorRef& executor) const;
  /// Lowers the expected squared errors of pixels, means over the channels, row by row: those of
  /// pixels with samples that are constant in all channels. That no pixel was seen not to be
  /// constant makes it likely that at most one in the number of those that could have been is not;
  /// half of the range may then be on either side of an edge.
  void lower_errors(std::span<float> errors, const ExecutorRef& executor) const;

 private:
  /// Pixels of a block of the picture, the last ones narrower.
  struct Part {
    std::size_t left, top, right, bottom;
  };
  [[nodiscard]] Part part(std::size_t block) const;
  [[nodiscard]] std::size_t at(std::size_t x, std::size_t y, std::size_t channel) const {
    return (y * tree_.grid().width + x) * tree_.channels() + channel;
  }
  void look_at(std::size_t block, std::size_t channel);
  void count_pairs(std::size_t block, std::size_t channel);
  [[nodiscard]] PixelAgreement around(std::size_t block, std::size_t channel) const;
  [[nodiscard]] PixelAgreement beside(const Part& part, std::size_t x, std::size_t y,
                                      std::size_t channel, std::size_t reach) const;
  template <class Task>
  void each_block(const ExecutorRef& executor, Task&& task) const;

  const NodeTree& tree_;
  std::vector<float> means_;                // of each pixel and channel
  std::vector<std::uint32_t> counts_;       // of samples, those on borders left out
  std::vector<PixelAgreement> agreements_;  // of each block and channel
  std::vector<std::uint32_t> pairs_;        // of each, that prove something
};

}  // namespace freqsynth::detail

#include "freqsynth/image/constant_pixels.inl"
