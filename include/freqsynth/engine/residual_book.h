// SPDX-License-Identifier: MIT
/// \file
/// The residuals of all blocks, as measures see them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_view.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// The plausible residuals of all blocks, and what blocks know of those beside them.
class ResidualBook {
 public:
  /// All residuals are 0.
  explicit ResidualBook(std::size_t blocks) : residuals_(blocks), told_(blocks) {}

  /// In other units all residuals are so many times as large.
  void rescale(float factor) {
    // The sum is not added up anew for channels that have no say here.
    if (factor == 1) return;
    sum_ = 0;
    for (float& residual : residuals_) sum_ += double{residual *= factor};
    for (float& residual : told_) residual *= factor;
  }

  /// A block has other residuals now.
  void note(std::uint32_t block, float residual) { add(exchange(block, residual)); }
  /// The same in two steps, of which this one touches nothing but the block. \return for add()
  double exchange(std::uint32_t block, float residual) {
    return double{residual} - double{std::exchange(residuals_[block], residual)};
  }
  /// The second step, in an order that results depend on.
  void add(double change) { sum_ += change; }

  /// Variance of the residuals of a block, weighted over the channels.
  [[nodiscard]] float of(std::uint32_t block) const { return residuals_[block]; }
  /// The mean over all blocks.
  [[nodiscard]] float mean() const {
    return static_cast<float>(sum_ / static_cast<double>(residuals_.size()));
  }

  /// Whether the residuals of a block have grown by a quarter over what it told the others; from
  /// then on they know. Blocks that get samples hear of their neighbours then, but those that wait
  /// for long have to be told.
  bool has_news(std::uint32_t block) {
    const float residual = residuals_[block];
    const bool more = residual > 1.25f * told_[block];
    const bool less = residual < 0.5f * told_[block];
    if (more || less) told_[block] = residual;
    return more;
  }

  /// residual(block), a variance, pooled with that of the blocks beside it as `neighbours` samples,
  /// and with the mean of all blocks as `image` samples.
  template <Refiner R, class Residual>
  [[nodiscard]] float pooled(const BlockView<R>& view, std::uint32_t block, Residual&& residual,
                             float neighbours, float image) const {
    float weight = view.blocks.freedom(block);
    float sum = weight * residual(block);
    float beside = 0, blocks = 0;
    view.grid.visit_beside(block, [&](std::uint32_t other) {
      beside += residual(other);
      ++blocks;
    });
    if (blocks > 0) {
      sum += neighbours * beside / blocks;
      weight += neighbours;
    }
    sum += image * mean();
    return sum / (weight + image);
  }

 private:
  friend struct StateArchive;
  std::vector<float> residuals_;
  std::vector<float> told_;
  double sum_ = 0;
};

}  // namespace freqsynth
