// SPDX-License-Identifier: MIT
/// \file
/// Images of a store of blocks: what the refiner says of each, as it is and finished.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/noisy_picture.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/image/smooth_noise.h"
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
[[nodiscard]] FrequencyImage fit_image(const BlockGrid& grid, const BlockStore<R>& blocks) {
  const std::size_t channels = blocks.refiner().channels();
  FrequencyImage image(grid.width, grid.height, channels);
  std::vector<Gap> gaps;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t x = grid.column(b);
    const std::size_t y = grid.row(b);
    image.samples(x, y) = blocks.samples(b);
    for (std::size_t c = 0; c < channels; ++c) {
      const auto coefficients = image.coefficients(x, y, c);
      const BlockFit fit = blocks.fit_without_gaps(b, c, gaps);
      std::copy(fit.coefficients.begin(), fit.coefficients.end(), coefficients.begin());
      detail::to_host_unit(coefficients, blocks.exponent(c));
    }
  }
  return image;
}

namespace detail {

/// Which blocks of an image are constant within their pixels.
template <Refiner R>
class ImageAgreement {
 public:
  ImageAgreement(const BlockGrid& grid, const BlockStore<R>& blocks, const SharedInverseList& list)
      : grid_(grid), blocks_(blocks), list_(list) {
    order_.resize(blocks.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return blocks.samples(a) < blocks.samples(b);
    });
  }

  /// The blocks, those with fewer samples first.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

  /// Finds how well samples agree within pixels.
  void compare() {
    agreements_.resize(blocks_.size() * channels());
    OwnedSamples owned;
    std::size_t samples = 0;
    for (const std::uint32_t block : order_) {
      for (; samples < blocks_.samples(block); ++samples) owned.add(list_->row(samples));
      for (std::size_t c = 0; c < channels(); ++c) {
        agreements_[block * channels() + c] = blocks_.has_gaps(block, c)
                                                  ? PixelAgreement::none()
                                                  : owned.agreement(blocks_.fit(block, c));
      }
    }
  }
  /// Whether the pixels of a block and of those around it are constant.
  [[nodiscard]] bool constant_pixels(std::uint32_t block, std::size_t channel) const {
    const std::size_t x = grid_.column(block), y = grid_.row(block);
    PixelAgreement around;
    for (std::size_t v = y > 0 ? y - 1 : 0; v < std::min(y + 2, grid_.blocks_y); ++v) {
      for (std::size_t u = x > 0 ? x - 1 : 0; u < std::min(x + 2, grid_.blocks_x); ++u) {
        around.join(agreements_[(v * grid_.blocks_x + u) * channels() + channel]);
      }
    }
    return around.holds();
  }

 private:
  [[nodiscard]] std::size_t channels() const { return blocks_.refiner().channels(); }

  const BlockGrid& grid_;
  const BlockStore<R>& blocks_;
  const SharedInverseList& list_;
  std::vector<std::uint32_t> order_;  // of the blocks, those with fewer samples first
  std::vector<PixelAgreement> agreements_;
};

}  // namespace detail

namespace detail {

/// The cells of all blocks as one picture with noise.
class BlockPicture {
 public:
  BlockPicture(const BlockGrid& grid, std::size_t channels) : grid_(grid) {
    picture_.width = grid.blocks_x * block_size;
    picture_.height = grid.blocks_y * block_size;
    picture_.weights.resize(picture_.width * picture_.height);
    picture_.sums.assign(channels, picture_.weights);
    picture_.pixels.assign(channels, picture_.weights);
    picture_.variances.assign(channels, NoisyPicture::Plane(grid.size()));
  }

  /// Takes what the samples of a block say, and its finished coefficients.
  void add(const PixelFinisher& finisher, const BlockFit& fit, std::size_t block,
           std::size_t channel, std::span<const float, max_terms> coefficients) {
    std::array<float, max_terms> weights, sums, pixels;
    inverse_dct(coefficients, pixels);
    finisher.pixel_samples(fit, pixels, weights, sums);
    picture_.variances[channel][block] = fit.residual;
    visit(block, [&](std::size_t cell, std::size_t pixel) {
      picture_.weights[pixel] = weights[cell];
      picture_.sums[channel][pixel] = sums[cell];
      picture_.pixels[channel][pixel] = pixels[cell];
    });
  }

  /// Smooths the channels that have a weight.
  void smooth(std::span<const float> weights, std::span<const std::size_t> features) {
    std::vector<std::size_t> channels;
    for (std::size_t c = 0; c < weights.size(); ++c) {
      if (weights[c] > 0) channels.push_back(c);
    }
    smooth_noise(picture_, channels, features);
  }

  /// The coefficients of a block.
  void take(std::size_t block, std::size_t channel,
            std::span<float, max_terms> coefficients) const {
    std::array<float, max_terms> pixels;
    visit(block, [&](std::size_t cell, std::size_t pixel) {
      pixels[cell] = picture_.pixels[channel][pixel];
    });
    forward_dct(pixels, coefficients);
  }

 private:
  /// Calls visit(cell of the block, pixel of the picture).
  template <class Visit>
  void visit(std::size_t block, Visit&& visit) const {
    const std::size_t first =
        (grid_.row(block) * picture_.width + grid_.column(block)) * block_size;
    for (std::size_t cell = 0; cell < max_terms; ++cell) {
      visit(cell, first + cell / block_size * picture_.width + cell % block_size);
    }
  }

  const BlockGrid& grid_;
  NoisyPicture picture_;
};

}  // namespace detail

/// Finished pixels (CoefficientMeaning::pixel_average).
/// \param list      the one that the blocks were refined with
/// \param features  channels without a weight that guide the smoothing of noise
/// \throws std::invalid_argument when a setting is out of range.
template <Refiner R>
[[nodiscard]] FrequencyImage finished_image(const BlockGrid& grid, const BlockStore<R>& blocks,
                                            const SharedInverseList& list,
                                            const FinishSettings& settings,
                                            std::span<const std::size_t> features = {}) {
  const std::size_t channels = blocks.refiner().channels();
  FrequencyImage image(grid.width, grid.height, channels, CoefficientMeaning::pixel_average);
  detail::ImageAgreement<R> agreement(grid, blocks, list);
  if (settings.residuals) agreement.compare();
  const bool smooth =
      settings.residuals && settings.smooth_noise && settings.noise == Noise::present;
  detail::BlockPicture picture(grid, smooth ? channels : 0);
  PixelFinisher finisher(list, settings);
  std::vector<Gap> gaps;
  for (const std::uint32_t block : agreement.order()) {
    const std::size_t x = grid.column(block);
    const std::size_t y = grid.row(block);
    image.samples(x, y) = blocks.samples(block);
    finisher.advance(blocks.samples(block));
    for (std::size_t c = 0; c < channels; ++c) {
      const bool constant = settings.residuals && agreement.constant_pixels(block, c);
      const BlockFit fit = blocks.fit_without_gaps(block, c, gaps);
      finisher.finish(fit, image.coefficients(x, y, c), constant);
      if (smooth) picture.add(finisher, fit, block, c, image.coefficients(x, y, c));
    }
  }
  if (smooth) picture.smooth(blocks.refiner().weights(), features);
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    for (std::size_t c = 0; c < channels; ++c) {
      const auto coefficients = image.coefficients(grid.column(block), grid.row(block), c);
      if (smooth) picture.take(block, c, coefficients);
      detail::to_host_unit(coefficients, blocks.exponent(c));
    }
  }
  return image;
}

}  // namespace freqsynth
