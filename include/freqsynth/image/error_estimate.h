// SPDX-License-Identifier: MIT
/// \file
/// How far the finished pixels of a block are expected to be from the true means, by what its fit
/// leaves over.
///
/// Without noise the error is R a / (1 + b w)^1.35 for w samples per pixel whose residuals have the
/// variance R: nearly w^-1.5, as of edges that evenly spread samples are counted on both sides of.
/// (Where there is one sample per pixel or less, it is a share of R.) How R compares with the
/// energy of the highest terms of the fit tells edges, of which energy falls as 1 / frequency^3,
/// from what is smooth, where the error is smaller, and from texture that the fit does not hold,
/// where it is larger. Where there is noise, the error of the fit's terms is known by Stein's
/// unbiased estimate, for independent samples: noise that is left in terms which stand out of it,
/// and what is lost with the others. The smoothing takes most of what is left where it is little.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/finish_settings.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// The expected squared error of a block's pixels, a mean over them. Parts are alike in all pixels
/// (`even`), or where the picture changes much from pixel to pixel (`detail`).
struct BlockError {
  double even = 0;          ///< does not depend on the variance of residuals; a square
  double even_share = 0;    ///< of the variance of residuals
  double detail_share = 0;  ///< of the variance of residuals

  /// The whole. \param variance  of the residuals, in the block or around it
  [[nodiscard]] double mean(double variance) const {
    return even + (even_share + detail_share) * variance;
  }
};

/// Estimates the errors of blocks.
class FREQSYNTH_API ErrorEstimate {
 public:
  /// What is known of a block beside its fit.
  struct Known {
    std::size_t samples = 0;  ///< with usable values, at least 1
    std::size_t terms = 0;    ///< of the fit
    float area = 1;           ///< of the block, relative to that of 8 x 8 pixels
    double surprise = 0;      ///< see SurpriseBook::expected()
  };

  /// \param settings  of the finished pixels; Noise::automatic is `none`
  /// \throws std::invalid_argument when one is out of range.
  explicit ErrorEstimate(const FinishSettings& settings);

  /// The error of a channel of a block, in the unit of its fit.
  [[nodiscard]] BlockError of(const BlockFit& fit, const Known& known);

  /// How BlockError::detail_share spreads over the pixels of a block: 64 factors, row by row, whose
  /// mean is 1.
  static void spread(const BlockFit& fit, std::span<float, max_terms> factors);

 private:
  [[nodiscard]] BlockError of_noise(const BlockFit& fit, const Known& known);

  FinishSettings settings_;
  detail::ButterworthTable filter_;
  std::array<double, max_terms> box_;  // mean over a pixel of each term, relative to its centre
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/error_estimate.inl"
#endif
