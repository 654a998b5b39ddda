// SPDX-License-Identifier: MIT
/// \file
/// Finished blocks as one picture, whose noise is smoothed.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/lift_negative.h"
#include "freqsynth/image/noisy_picture.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/image/smooth_noise.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {
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
  /// \param positive  no pixel is to be below zero
  void take(std::size_t block, std::size_t channel, bool positive,
            std::span<float, max_terms> coefficients) const {
    std::array<float, max_terms> pixels;
    visit(block, [&](std::size_t cell, std::size_t pixel) {
      pixels[cell] = picture_.pixels[channel][pixel];
    });
    if (positive) lift_negative(pixels);
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

}  // namespace freqsynth
