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
/// the samples around have shown, above all where those within pixels show the flat side of the
/// edge; where these show a picture that is constant within pixels, each pixel is what its own
/// samples say.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/own_means.h"
#include "freqsynth/image/pixel_agreement.h"
#include "freqsynth/image/shared_border.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// How pixels are made of a fit and its residuals.
struct FinishSettings {
  ButterworthSettings butterworth = {};  ///< the filter of the fit
  /// false: the paper's estimate, the mean of the filtered fit alone. The settings below are for
  /// true.
  bool residuals = true;
  /// A pixel's residuals with a total weight of w samples count w / (w + doubt). Finite and >= 0.
  double doubt = 0.5;
  /// The doubt is measured in each block that has a sample per pixel or more: variance of the
  /// residuals within pixels over that of the pixels' true means. It is right for independent
  /// samples; of a function without noise evenly spread samples tell more.
  bool measure_doubt = false;
  /// A coefficient F with an expected squared error of e counts max(0, 1 - shrinkage e / F^2).
  /// Finite and >= 0; 1 is the empirical Wiener filter.
  double shrinkage = 2;
  /// A pixel stays within the range of the means of the samples in it and in its 8 neighbours of
  /// the same block, widened on each side by this share of the distance between its end and the
  /// median; where fewer than 4 of them have samples, in the range of the whole block. Only in
  /// blocks whose residuals are over 1 percent of that range. >= 0; infinite: no bounds.
  double slack = 0.4;
  /// How far a fit rings beside an edge, as a share of the range of the whole block's means. A
  /// pixel that is off by at most as much from what its own samples and those of two neighbours
  /// show alike is held at that; and in any case where all eight neighbours show the same. In the
  /// same blocks as `slack`, unless that is infinite. Finite and >= 0; 0: no pixel is held.
  double ringing = 0.025;
  /// Where no sample of a channel is negative, in the whole picture, no pixel is: what is added to
  /// pixels below zero is taken from the others of their block in proportion. Signed functions stay
  /// as they are.
  bool keep_positive = true;

  /// For a sampler that returns Monte Carlo estimates.
  [[nodiscard]] static FinishSettings noisy() {
    FinishSettings settings;
    settings.doubt = 1;
    settings.measure_doubt = true;
    return settings;
  }

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate() const;
};

/// What the samples of a picture say of the pixels of one block, beyond its fit.
struct PixelEvidence {
  /// The picture is constant within each pixel, as PixelAgreement of this block and of those around
  /// says.
  bool constant_pixels = false;
  /// No sample of the channel was negative.
  bool positive = false;
  BlocksMeans own_means = {};  ///< of samples within pixels, here and around
};

/// Finishes blocks, those with fewer samples first. What depends on positions alone, the sum over
/// each pixel's samples of every term, is shared by all blocks with the same number of samples.
class FREQSYNTH_API PixelFinisher {
 public:
  /// \throws std::invalid_argument when a setting is out of range or there is no list.
  PixelFinisher(SharedInverseList list, const FinishSettings& settings);

  /// Goes on to blocks with `samples` samples; not less than before.
  void advance(std::size_t samples);

  /// Samples on the border that show what lies beyond an edge there; a fit without them is better.
  [[nodiscard]] std::vector<Gap> foreign_samples(const BlockFit& fit,
                                                 const PixelEvidence& evidence) const;

  /// Coefficients of finished pixels (CoefficientMeaning::pixel_average).
  void finish(const BlockFit& fit, std::span<float, max_terms> out,
              const PixelEvidence& evidence = {}) const;

 private:
  void finish_without_gaps(const BlockFit& fit, std::span<float, max_terms> out,
                           const PixelEvidence& evidence) const;
  void filter(const BlockFit& fit, std::span<float, max_terms> filtered) const;
  double measured_doubt(const BlockFit& fit, std::span<const float, max_terms> filtered,
                        const detail::AlignedBlock& means) const;
  void bound(const BlockFit& fit, std::span<float, max_terms> pixels,
             const PixelEvidence& evidence) const;

  SharedInverseList list_;
  FinishSettings settings_;
  std::size_t samples_ = 0;
  std::array<float, max_terms> box_;      // mean over a pixel of each term, relative to its centre
  std::array<float, max_terms> filter_;   // Butterworth factors
  std::array<float, max_terms> weights_;  // samples of each pixel
  OwnedSamples owned_;
  SharedBorder border_;
  detail::AlignedBlock inverse_weights_;  // 0 without samples
  // [pixel][row-major term]: weighted sum of the term over the pixel's samples
  detail::AlignedVector<float> sums_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/pixel_finisher.inl"
#endif
