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
    if (row.own_pixel != detail::SampleRow::no_pixel) ++counts_[row.own_pixel];
  }

  /// One that was added less.
  void remove(const detail::SampleRow& row) {
    if (row.own_pixel != detail::SampleRow::no_pixel) --counts_[row.own_pixel];
  }

  /// Whether a pixel has any.
  [[nodiscard]] bool any(std::size_t pixel) const { return counts_[pixel] > 0; }
  /// The mean of those in a pixel that has some, of their sums in each pixel (BlockFit::own_sums).
  [[nodiscard]] float mean(std::span<const float> sums, std::size_t pixel) const {
    return sums[pixel] / static_cast<float>(counts_[pixel]);
  }
  /// The means in all pixels; OwnMeans::unknown where there is none, or no sum is known.
  void means(std::span<const float> sums, std::span<float, max_terms> out) const {
    for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
      out[pixel] = any(pixel) && !sums.empty() ? mean(sums, pixel) : OwnMeans::unknown;
    }
  }
  /// How well those of a block agree within its pixels; not at all where that is not known.
  /// \param fit  of all samples, none of which was a gap
  [[nodiscard]] PixelAgreement agreement(const BlockFit& fit) const {
    if (fit.own_sums.empty()) return PixelAgreement::none();
    PixelAgreement agreement;
    agreement.spread = fit.spread;
    for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
      if (!any(pixel)) continue;
      agreement.low = std::min(agreement.low, mean(fit.own_sums, pixel));
      agreement.high = std::max(agreement.high, mean(fit.own_sums, pixel));
      agreement.pairs += counts_[pixel] > 1 ? 1 : 0;
    }
    return agreement;
  }

 private:
  std::array<std::uint32_t, max_terms> counts_ = {};
};

}  // namespace freqsynth
