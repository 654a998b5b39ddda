// SPDX-License-Identifier: MIT
/// \file
/// Local linear regression of noisy samples on what is known of each pixel beside them.
///
/// Moon et al. (2014) and Bitterli et al. (2016) regress the radiance of noisy pixels on features
/// that are nearly free of noise (colour, normal, distance of the first surface), pixel by pixel.
/// Here the regression is a guided filter (He et al. 2010) whose pixels count by their samples: one
/// fit for each small cell, to the samples of the cells around it, and pixels between the cells'
/// centres take the mean of the four predictions. It shows no borders, neither of cells nor of
/// blocks, and keeps the mean of the samples.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/large_pages.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/image/linear_blend.h"
#include "freqsynth/image/noisy_picture.h"

namespace freqsynth {
namespace detail {

/// One regression for each cell, of several targets on the same guides and on the position.
class FREQSYNTH_API GuidedRegression {
 public:
  static constexpr std::size_t no_target = std::numeric_limits<std::size_t>::max();

  /// What targets are regressed on.
  struct Guide {
    const float* at_samples;  ///< of each pixel, the mean over its samples
    const float* at_pixels;   ///< of each pixel, the mean over its area
    double ridge;  ///< added to the guide's variance in a window, in its own unit squared
    /// Another ridge, in units of the variance that noise gives to a pixel's mean.
    double noise_ridge = 0;
    /// The variance of a sample is at least this in each block (row by row), 0 without any.
    const float* variances = nullptr;
    /// The number of the target that the guide is an estimate of: then the variance of a sample is
    /// at least what the guide leaves over of it.
    std::size_t of_target = no_target;
  };
  /// What counts for a fit.
  struct Window {
    std::size_t cell;   ///< side of the cells in pixels; picture's sides are multiples of it
    std::size_t reach;  ///< cells on each side of one that count for it, the less the farther
  };

  /// \param sums  of each target, those of the picture's samples in each pixel
  GuidedRegression(const NoisyPicture& picture, const Window& window, std::vector<Guide> guides,
                   std::vector<const float*> sums, const ExecutorRef& executor = {});

  /// The predictions of all targets for each pixel; where no cell around has a sample, nothing
  /// changes.
  void predict(std::span<const std::span<float>> pixels, const ExecutorRef& executor = {}) const;

 private:
  // A cell's sums: weight, pixels with samples, of each target its sum, of each guide the variance
  // of samples, of each term its sum, of each pair of terms and of each term and target the
  // product's.
  [[nodiscard]] std::size_t first_target() const { return 2; }
  [[nodiscard]] std::size_t first_variance() const { return first_target() + sums_.size(); }
  [[nodiscard]] std::size_t first_term() const { return first_variance() + guides_.size(); }
  [[nodiscard]] std::size_t first_pair() const { return first_term() + terms_; }
  [[nodiscard]] std::size_t first_product() const {
    return first_pair() + terms_ * (terms_ + 1) / 2;
  }

  /// Memory that fits are made in.
  struct Work {
    std::vector<std::vector<double>> rows;  // sums of cells, by turns
    std::vector<double> column, window;
    // Of four cells side by side: sums, their systems, pixels of the window, and which they are.
    AlignedVector<double> sums, matrix, right;
    AlignedArray<double, 4> pixels, definite;
    std::array<std::size_t, 4> cells;
    std::size_t count = 0;
  };

  void collect(std::size_t cell_y, std::span<double> row) const;
  void fit_rows(std::size_t first, std::size_t last, Work& work);
  void fit_row(std::size_t y, Work& work);
  void fit_cells(std::size_t y, Work& work);
  void predict_row(std::size_t y, std::span<const std::span<float>> pixels) const;

  const NoisyPicture& picture_;
  Window window_;
  std::vector<Guide> guides_;
  std::vector<const float*> sums_;
  std::size_t cells_x_, cells_y_, terms_, moments_, slopes_;
  std::vector<LinearBlend<float>> columns_, lines_;  // of pixels
  // [cell][target]: value at the cell's centre where guides are 0, and the slopes; not a number
  // without samples.
  LargeVector<float> fits_;
};

}  // namespace detail
}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/guided_regression.inl"
#endif
