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
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/finish_settings.h"
#include "freqsynth/image/own_means.h"
#include "freqsynth/image/pixel_agreement.h"
#include "freqsynth/image/shared_border.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

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
  /// \param filters  the factors of the settings' filter after all numbers of samples that will
  ///                 come, which it refers to; null: they are computed
  /// \throws std::invalid_argument when a setting is out of range or there is no list.
  PixelFinisher(SharedInverseList list, const FinishSettings& settings,
                const detail::ButterworthFilters* filters = nullptr);

  /// Back to blocks without samples.
  void restart();

  /// Goes on to blocks with `samples` samples; not less than before.
  void advance(std::size_t samples);

  /// Samples on the border that show what lies beyond an edge there; a fit without them is better.
  [[nodiscard]] std::vector<Gap> foreign_samples(const BlockFit& fit,
                                                 const PixelEvidence& evidence) const;

  /// Coefficients of finished pixels (CoefficientMeaning::pixel_average).
  void finish(const BlockFit& fit, std::span<float, max_terms> out,
              const PixelEvidence& evidence = {}) const;

  /// The same coefficients row by row (v, u).
  void finish_rows(const BlockFit& fit, detail::AlignedBlock& out,
                   const PixelEvidence& evidence = {}) const;

  /// How many samples each pixel of a block has, by area, and their sums. A sample that was a gap
  /// counts as much as the pixel's others on average; where there is none, `otherwise` stands for
  /// them.
  void pixel_samples(const BlockFit& fit, std::span<const float, max_terms> otherwise,
                     std::span<float, max_terms> weights, std::span<float, max_terms> sums) const;

 private:
  void finish_without_gaps(const BlockFit& fit, detail::AlignedBlock& out,
                           const PixelEvidence& evidence) const;
  void leave_out(std::span<const Gap> gaps, std::span<float, max_terms> weights,
                 std::span<float, max_terms> sums) const;
  void weigh();
  void add_terms(const detail::SampleRow& row, float sign);
  void filter(const BlockFit& fit, std::span<float, max_terms> filtered) const;
  double measured_doubt(const BlockFit& fit, std::span<const float, max_terms> filtered,
                        const detail::AlignedBlock& means) const;
  /// What samples have shown of pixels: PaddedBlock::none, or less than anything, where nothing.
  struct Means {
    detail::PaddedBlock low, high;
    detail::AlignedBlock counts;  ///< known ones among each pixel and those around it
  };
  std::size_t flat_means(const BlockFit& fit, std::span<float, max_terms> pixels,
                         Means& means) const;
  void bound(const BlockFit& fit, std::span<float, max_terms> pixels,
             const PixelEvidence& evidence) const;

  SharedInverseList list_;
  const detail::ButterworthFilters* filters_;
  FinishSettings settings_;
  std::size_t samples_ = 0;
  detail::AlignedBlock box_;  // mean over a pixel of each term, row-major, relative to its centre
  std::array<float, max_terms> filter_;  // Butterworth factors
  OwnedSamples owned_;
  SharedBorder border_;
  detail::AlignedBlock weights_;          // samples of each pixel
  detail::AlignedBlock inverse_weights_;  // 0 without samples
  detail::AlignedBlock counts_;           // pixels with samples among each and those around it
  std::size_t sampled_ = 0;               // pixels with samples
  // [pixel][row-major term]: weighted sum of the term over the pixel's samples
  detail::AlignedVector<float> sums_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/pixel_finisher.inl"
#endif
