// SPDX-License-Identifier: MIT
/// \file
/// Pictures that are constant within each pixel: those of edges that lie on the borders of pixels,
/// as of rectangles, of text at whole positions, of checkers and pixel art.
///
/// There the mean of a pixel's own samples is exact, and whatever else is known of the block can
/// only spoil it. The samples tell: all that lie in one pixel are equal, and so are those in the
/// pixels around. A slanted edge soon crosses a pixel with two samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/image/own_means.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// How well the samples within pixels agree, in one block or in several.
struct PixelAgreement {
  /// Greatest difference between a sample and the mean of the earlier ones in the same pixel.
  float spread = 0;
  /// Least mean of the samples in a pixel.
  float low = std::numeric_limits<float>::max();
  /// Greatest mean of the samples in a pixel.
  float high = std::numeric_limits<float>::lowest();
  std::uint32_t pairs = 0;  ///< pixels with two samples or more

  /// Nothing agrees.
  [[nodiscard]] static PixelAgreement none() {
    PixelAgreement agreement;
    agreement.spread = std::numeric_limits<float>::infinity();
    return agreement;
  }

  /// Of both together.
  void join(const PixelAgreement& other) {
    spread = std::max(spread, other.spread);
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    pairs += other.pairs;
  }

  /// Whether the picture can be taken to be constant within each pixel.
  [[nodiscard]] bool holds() const {
    constexpr std::uint32_t enough = 16;
    constexpr float visible = 0.004f, rounding = 1e-5f;
    if (pairs < enough) return false;
    return spread <= visible * (high - low) + rounding * std::max(high, -low);
  }
};

/// How many samples lie in each pixel of a block.
class OwnedSamples {
 public:
  /// One more sample of the sequence.
  void add(const detail::SampleRow& row) {
    if (row.own_pixel == detail::SampleRow::no_pixel) return;
    counts_[row.own_pixel] += 1;
    pairs_ += counts_[row.own_pixel] == 2 ? 1 : 0;
  }

  /// One that was added less.
  void remove(const detail::SampleRow& row) {
    if (row.own_pixel == detail::SampleRow::no_pixel) return;
    pairs_ -= counts_[row.own_pixel] == 2 ? 1 : 0;
    counts_[row.own_pixel] -= 1;
  }

  /// Whether a pixel has any.
  [[nodiscard]] bool any(std::size_t pixel) const { return counts_[pixel] > 0; }
  /// The mean of those in a pixel that has some, of their sums in each pixel (BlockFit::own_sums).
  [[nodiscard]] float mean(std::span<const float> sums, std::size_t pixel) const {
    return sums[pixel] / counts_[pixel];
  }
  /// The means in all pixels; OwnMeans::unknown where there is none, or no sum is known.
  /// \return how well they agree, if none of the samples was a gap: the spread of the sums' fit is
  ///         still to be added; PixelAgreement::none() where that is not known
  PixelAgreement means(std::span<const float> sums, std::span<float, max_terms> out) const {
    static_assert(OwnMeans::unknown == detail::PaddedBlock::none);
    if (sums.empty()) {
      for (float& mean : out) mean = OwnMeans::unknown;
      return PixelAgreement::none();
    }
    std::array<float, 2> ends;
    detail::owned_means(sums.data(), counts_.data(), out.data(), ends.data());
    PixelAgreement agreement;
    agreement.low = ends[0];
    agreement.high = ends[1];
    agreement.pairs = pairs_;
    return agreement;
  }
  /// The same of a fit of all samples, none of which was a gap, with its spread.
  PixelAgreement agreement(const BlockFit& fit, std::span<float, max_terms> out) const {
    PixelAgreement agreement = means(fit.own_sums, out);
    agreement.spread = std::max(agreement.spread, fit.spread);
    return agreement;
  }

 private:
  detail::AlignedBlock counts_ = {};
  std::uint32_t pairs_ = 0;  // pixels with two or more
};

}  // namespace freqsynth
