// SPDX-License-Identifier: MIT
/// \file
/// Images of a store of blocks: what the refiner says of each, as it is and finished.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_snapshot.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/image/block_picture.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/own_means.h"
#include "freqsynth/image/pixel_agreement.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {
namespace detail {

/// Coefficients in units of 2 to the power of an exponent, in -126..126, in the host's unit.
inline void to_host_unit(std::span<float> coefficients, int exponent) {
  const float unit = std::ldexp(1.0f, exponent);
  for (float& coefficient : coefficients) coefficient *= unit;
}

}  // namespace detail

/// The fit itself (CoefficientMeaning::point_function).
template <Refiner R>
[[nodiscard]] FrequencyImage fit_image(const BlockGrid& grid, const BlockSnapshot<R>& blocks) {
  const std::size_t channels = blocks.channels();
  FrequencyImage image(grid.width, grid.height, channels);
  std::vector<Gap> gaps;
  detail::AlignedVector<float> state(blocks.state_size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t x = grid.column(b);
    const std::size_t y = grid.row(b);
    image.samples(x, y) = blocks.samples(b);
    blocks.read(b, state.data());
    for (std::size_t c = 0; c < channels; ++c) {
      const auto coefficients = image.coefficients(x, y, c);
      const BlockFit fit = blocks.fit_without_gaps(b, state.data(), c, gaps);
      std::copy(fit.coefficients.begin(), fit.coefficients.end(), coefficients.begin());
      detail::to_host_unit(coefficients, blocks.exponent(c));
    }
  }
  return image;
}

/// The same of blocks that nobody changes meanwhile.
template <Refiner R>
[[nodiscard]] FrequencyImage fit_image(const BlockGrid& grid, const BlockStore<R>& blocks) {
  return fit_image(grid, BlockSnapshot<R>(blocks));
}

namespace detail {

/// What samples within pixels show, of all blocks of an image.
template <Refiner R>
class ImageEvidence {
 public:
  ImageEvidence(const BlockGrid& grid, const BlockSnapshot<R>& blocks,
                const SharedInverseList& list)
      : grid_(grid), blocks_(blocks), list_(list) {
    order_.resize(blocks.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return blocks.samples(a) < blocks.samples(b);
    });
  }

  /// The blocks, those with fewer samples first.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

  /// Finds how well samples agree within pixels, and their means.
  void compare() {
    agreements_.resize(blocks_.size() * channels());
    means_.assign(agreements_.size() * max_terms, OwnMeans::unknown);
    OwnedSamples owned;
    std::size_t samples = 0;
    AlignedVector<float> state(blocks_.state_size());
    for (const std::uint32_t block : order_) {
      blocks_.read(block, state.data(), 2);
      for (; samples < blocks_.samples(block); ++samples) owned.add(list_->row(samples));
      for (std::size_t c = 0; c < channels(); ++c) {
        const std::size_t at = block * channels() + c;
        const BlockFit fit = blocks_.fit(block, state.data(), c);
        const std::vector<Gap> gaps = blocks_.gaps(block, c);
        if (!gaps.empty()) {
          agreements_[at] = PixelAgreement::none();
          compare_without_gaps(owned, fit, gaps, at);
        } else {
          agreements_[at] = owned.agreement(fit);
          owned.means(fit.own_sums, means_of(at));
        }
      }
    }
  }
  /// What is known of a block once compare() has been called.
  [[nodiscard]] PixelEvidence of(std::uint32_t block, std::size_t channel) const {
    const std::size_t x = grid_.column(block), y = grid_.row(block);
    PixelEvidence evidence;
    PixelAgreement around;
    for (std::size_t k = 0; k < 9; ++k) {
      // One less than 0 is beyond the end, too.
      const std::size_t u = x + k % 3 - 1, v = y + k / 3 - 1;
      if (u >= grid_.blocks_x || v >= grid_.blocks_y) continue;
      const std::size_t at = (v * grid_.blocks_x + u) * channels() + channel;
      around.join(agreements_[at]);
      evidence.own_means[k] = means_.data() + at * max_terms;
    }
    evidence.constant_pixels = around.holds();
    evidence.positive = !blocks_.any_negative(channel);
    return evidence;
  }

 private:
  [[nodiscard]] std::size_t channels() const { return blocks_.channels(); }
  [[nodiscard]] std::span<float, max_terms> means_of(std::size_t at) {
    return std::span<float, max_terms>(means_.data() + at * max_terms, max_terms);
  }
  void compare_without_gaps(OwnedSamples owned, const BlockFit& fit, std::span<const Gap> gaps,
                            std::size_t at) {
    if (fit.own_sums.empty()) return;
    std::array<float, max_terms> sums;
    std::copy(fit.own_sums.begin(), fit.own_sums.end(), sums.begin());
    for (const Gap& gap : gaps) {
      const SampleRow& row = list_->row(gap.sample);
      if (row.own_pixel != SampleRow::no_pixel) sums[row.own_pixel] -= gap.value;
      owned.remove(row);
    }
    owned.means(sums, means_of(at));
  }

  const BlockGrid& grid_;
  const BlockSnapshot<R>& blocks_;
  const SharedInverseList& list_;
  std::vector<std::uint32_t> order_;        // of the blocks, those with fewer samples first
  std::vector<PixelAgreement> agreements_;  // [block][channel]
  std::vector<float> means_;                // [block][channel][pixel]
};

}  // namespace detail

/// Finished pixels (CoefficientMeaning::pixel_average).
/// \param list      the one that the blocks were refined with
/// \param features  channels without a weight that guide the smoothing of noise
/// \throws std::invalid_argument when a setting is out of range.
template <Refiner R>
[[nodiscard]] FrequencyImage finished_image(const BlockGrid& grid, const BlockSnapshot<R>& blocks,
                                            const SharedInverseList& list,
                                            const FinishSettings& settings,
                                            std::span<const std::size_t> features = {}) {
  const std::size_t channels = blocks.channels();
  FrequencyImage image(grid.width, grid.height, channels, CoefficientMeaning::pixel_average);
  const bool smooth =
      settings.residuals && settings.smooth_noise && settings.noise == Noise::present;
  detail::BlockPicture picture(grid, smooth ? channels : 0);
  detail::ImageEvidence<R> evidence(grid, blocks, list);
  if (settings.residuals) evidence.compare();
  PixelFinisher finisher(list, settings);
  for (std::size_t c = 0; c < channels; ++c) {
    const bool positive = settings.residuals && settings.keep_positive && !blocks.any_negative(c);
    image.set_non_negative(c, positive);
  }
  std::vector<Gap> gaps;
  detail::AlignedVector<float> state(blocks.state_size());
  for (const std::uint32_t block : evidence.order()) {
    blocks.read(block, state.data(), settings.residuals ? 2 : 1);
    const std::size_t x = grid.column(block);
    const std::size_t y = grid.row(block);
    image.samples(x, y) = blocks.samples(block);
    finisher.advance(blocks.samples(block));
    for (std::size_t c = 0; c < channels; ++c) {
      const PixelEvidence known = settings.residuals ? evidence.of(block, c) : PixelEvidence();
      const std::span<float, max_terms> pixels = image.coefficients(x, y, c);
      const BlockFit fit = blocks.fit_without_gaps(block, state.data(), c, gaps);
      const std::vector<Gap> foreign = finisher.foreign_samples(fit, known);
      if (foreign.empty()) {
        finisher.finish(fit, pixels, known);
      } else {
        finisher.finish(blocks.fit_without(block, state.data(), c, foreign), pixels, known);
      }
      if (smooth) picture.add(finisher, fit, block, c, pixels);
    }
  }
  if (smooth) picture.smooth(blocks.refiner().weights(), features);
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    for (std::size_t c = 0; c < channels; ++c) {
      const auto coefficients = image.coefficients(grid.column(block), grid.row(block), c);
      if (smooth) picture.take(block, c, image.non_negative(c), coefficients);
      detail::to_host_unit(coefficients, blocks.exponent(c));
    }
  }
  return image;
}

/// The same of blocks that nobody changes meanwhile.
template <Refiner R>
[[nodiscard]] FrequencyImage finished_image(const BlockGrid& grid, const BlockStore<R>& blocks,
                                            const SharedInverseList& list,
                                            const FinishSettings& settings,
                                            std::span<const std::size_t> features = {}) {
  return finished_image(grid, BlockSnapshot<R>(blocks), list, settings, features);
}

}  // namespace freqsynth
