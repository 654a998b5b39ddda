// SPDX-License-Identifier: MIT
/// \file
/// From the fit of a block to finished pixels: beyond the paper, what the fit leaves over is not
/// thrown away.
///
/// A band-limited function cannot hold an edge, so the error of the paper's estimate stops falling
/// at a few samples per pixel. Here the fit is a control variate: a pixel's mean is the exact mean
/// of the filtered fit plus the average of (sample - fit) over the pixel's own samples, shrunk
/// while they are few. That converges to the true mean.
///
/// The fit itself is filtered by what it says of itself, too: a coefficient that is hardly larger
/// than its expected error is mostly noise. And a fit that rings beside an edge is held within what
/// the samples around have shown; where these show a picture that is constant within pixels, each
/// pixel is what its own samples say.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/noise.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/pixel_agreement.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// How pixels are made of a fit and its residuals.
struct FinishSettings {
  ButterworthSettings butterworth = {};  ///< the filter of the fit
  /// false: the paper's estimate, the mean of the filtered fit alone. The settings below are for
  /// true.
  bool residuals = true;
  /// Whether samples are Monte Carlo estimates. Synthesizer::finished_image() knows what
  /// `automatic` is; without a synthesis it is `none`.
  Noise noise = Noise::automatic;
  /// A pixel's residuals with a total weight of w samples count w / (w + doubt). Finite and >= 0.
  double doubt = 0.5;
  /// The same where there is noise.
  double noisy_doubt = 1;
  /// Where there is noise, the doubt is measured in each block that has a sample per pixel or more:
  /// variance of the residuals within pixels over that of the pixels' true means. It is right for
  /// independent samples; of a function without noise evenly spread samples tell more.
  bool measure_doubt = true;
  /// A coefficient F with an expected squared error of e counts max(0, 1 - shrinkage e / F^2).
  /// Finite and >= 0; 1 is the empirical Wiener filter.
  double shrinkage = 2;
  /// A pixel stays within the range of the means of the samples in it and in its 8 neighbours of
  /// the same block, widened on each side by this share of the distance between its end and the
  /// median; where fewer than 4 of them have samples, in the range of the whole block. Only in
  /// blocks whose residuals are over 1 percent of that range. >= 0; infinite: no bounds.
  double slack = 0.4;
  /// Where there is noise, what is left of it is smoothed over the whole picture in all channels
  /// that steer, with those of ChannelRole::feature as guides; see smooth_noise().
  bool smooth_noise = true;

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate() const;
};

/// Finishes blocks, those with fewer samples first. What depends on positions alone, the sum over
/// each pixel's samples of every term, is shared by all blocks with the same number of samples.
class FREQSYNTH_API PixelFinisher {
 public:
  /// \throws std::invalid_argument when a setting is out of range or there is no list.
  PixelFinisher(SharedInverseList list, const FinishSettings& settings);

  /// Goes on to blocks with `samples` samples; not less than before.
  void advance(std::size_t samples);

  /// Coefficients of finished pixels (CoefficientMeaning::pixel_average).
  /// \param constant_pixels  the picture is constant within each pixel, as PixelAgreement of this
  ///                         block and of those around says
  void finish(const BlockFit& fit, std::span<float, max_terms> out,
              bool constant_pixels = false) const;

  /// How many samples each pixel of a block has, by area, and their sums. A sample that was a gap
  /// counts as much as the pixel's others on average; where there is none, `otherwise` stands for
  /// them.
  void pixel_samples(const BlockFit& fit, std::span<const float, max_terms> otherwise,
                     std::span<float, max_terms> weights, std::span<float, max_terms> sums) const;

 private:
  void finish_without_gaps(const BlockFit& fit, std::span<float, max_terms> out) const;
  void filter(const BlockFit& fit, std::span<float, max_terms> filtered) const;
  double measured_doubt(const BlockFit& fit, std::span<const float, max_terms> filtered,
                        const detail::AlignedBlock& means) const;
  void bound(const BlockFit& fit, std::span<float, max_terms> pixels, bool constant_pixels) const;

  SharedInverseList list_;
  FinishSettings settings_;
  std::size_t samples_ = 0;
  std::array<float, max_terms> box_;      // mean over a pixel of each term, relative to its centre
  std::array<float, max_terms> filter_;   // Butterworth factors
  std::array<float, max_terms> weights_;  // samples of each pixel
  OwnedSamples owned_;
  detail::AlignedBlock inverse_weights_;  // 0 without samples
  // [pixel][row-major term]: weighted sum of the term over the pixel's samples
  detail::AlignedVector<float> sums_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/pixel_finisher.inl"
#endif
