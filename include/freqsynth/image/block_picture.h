// SPDX-License-Identifier: MIT
/// \file
/// Finished blocks as one picture, whose noise is smoothed.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/lift_negative.h"
#include "freqsynth/image/noisy_picture.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/image/smooth_noise.h"
#include "freqsynth/image/smoothing_features.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {
namespace detail {

/// The cells of all blocks as one picture with noise: of the channels that are smoothed, which have
/// a weight, and of those that guide this.
class BlockPicture {
 public:
  BlockPicture(const BlockGrid& grid, std::span<const float> weights,
               const SmoothingFeatures& features)
      : grid_(grid), planes_(weights.size(), none) {
    for (std::size_t c = 0; c < weights.size(); ++c) {
      if (weights[c] > 0) use(c, smoothed_);
    }
    for (const std::size_t c : features.fitted) use(c, features_);
    first_mean_ = smoothed_.size() + features_.size();
    const std::size_t means = features.means ? features.means->channels() : 0;
    const std::size_t channels = first_mean_ + means;
    for (std::size_t c = first_mean_; c < channels; ++c) {
      features_.push_back(c);
      picture_.seamless.push_back(c);
    }
    picture_.width = grid.blocks_x * block_size;
    picture_.height = grid.blocks_y * block_size;
    picture_.weights.resize(picture_.width * picture_.height);
    picture_.sums.assign(channels, picture_.weights);
    picture_.pixels.assign(channels, picture_.weights);
    picture_.variances.assign(channels, NoisyPicture::Plane(grid.size()));
  }

  /// Whether a channel is in the picture.
  [[nodiscard]] bool has(std::size_t channel) const { return planes_[channel] != none; }

  /// Takes what the samples of a block say, and its finished coefficients, row by row.
  void add(const PixelFinisher& finisher, const BlockFit& fit, std::size_t block,
           std::size_t channel, const AlignedBlock& rows) {
    std::array<float, max_terms> weights, sums;
    AlignedBlock pixels;
    evaluate_coefficients(rows, pixels);
    finisher.pixel_samples(fit, pixels, weights, sums);
    const std::size_t plane = planes_[channel];
    picture_.variances[plane][block] = fit.residual;
    visit(block, [&](std::size_t cell, std::size_t pixel) {
      picture_.weights[pixel] = weights[cell];
      picture_.sums[plane][pixel] = sums[cell];
      picture_.pixels[plane][pixel] = pixels[cell];
    });
  }

  /// Takes the features of which pixels keep means, once all blocks are there.
  void add_means(const PixelStore& store, double doubt, const ExecutorRef& executor) {
    share_pieces(executor, store.channels(), [&](std::size_t c) {
      MeanFeature feature = mean_feature(grid_, store, c, doubt);
      const std::size_t plane = first_mean_ + c;
      NoisyPicture::Plane& sums = picture_.sums[plane];
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] = feature.means[i] * picture_.weights[i];
      }
      picture_.pixels[plane] = std::move(feature.pixels);
      picture_.variances[plane] = std::move(feature.variances);
    });
  }

  /// Smooths the channels that have a weight.
  void smooth(const ExecutorRef& executor) {
    smooth_noise_on(picture_, smoothed_, features_, executor);
  }

  /// The coefficients of a block, row by row.
  /// \param positive  no pixel is to be below zero
  void take(std::size_t block, std::size_t channel, bool positive, AlignedBlock& rows) const {
    AlignedBlock pixels;
    const NoisyPicture::Plane& plane = picture_.pixels[planes_[channel]];
    visit(block, [&](std::size_t cell, std::size_t pixel) { pixels[cell] = plane[pixel]; });
    if (positive) lift_negative(pixels);
    transform_to_rows(pixels, rows);
  }
  /// What becomes of the coefficients of a channel that is not in the picture.
  static void pass(const AlignedBlock& rows, bool positive, AlignedBlock& out) {
    AlignedBlock pixels;
    evaluate_coefficients(rows, pixels);
    if (positive) lift_negative(pixels);
    transform_to_rows(pixels, out);
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// Eq. 2.
  static void evaluate_coefficients(const AlignedBlock& rows, AlignedBlock& pixels) {
    AlignedBlock amplitudes;
    for (std::size_t i = 0; i < max_terms; ++i) amplitudes[i] = rows[i] * row_major_amplitudes[i];
    evaluate_rows(amplitudes, pixels);
  }
  /// Gives a channel the next plane, unless it has one.
  void use(std::size_t channel, std::vector<std::size_t>& planes) {
    if (has(channel)) return;
    planes_[channel] = smoothed_.size() + features_.size();
    planes.push_back(planes_[channel]);
  }
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
  std::vector<std::size_t> planes_;               // of each channel
  std::vector<std::size_t> smoothed_, features_;  // planes
  std::size_t first_mean_ = 0;                    // plane; all after it are means
  NoisyPicture picture_;
};

}  // namespace detail

}  // namespace freqsynth
