// SPDX-License-Identifier: MIT
/// \file
/// Pixel filters, and the weighted average that reconstructs a picture from samples anywhere.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampler.h"

namespace baselines {

/// A separable filter around the centre of a pixel.
enum class PixelFilter : std::uint8_t {
  box,                ///< constant, 1 pixel wide
  tent,               ///< linear, 2 pixels wide
  gaussian,           ///< deviation 0.5 pixels, 3 pixels wide, lowered to end at 0
  mitchell_netravali  ///< cubic with B = C = 1/3, 4 pixels wide; partly negative
};

/// Half the width of a filter, in pixels.
[[nodiscard]] double radius(PixelFilter filter);

/// Weight along one axis at a signed distance from the centre of the pixel, in pixels. 0 beyond the
/// radius; not normalised. (Mitchell and Netravali, Reconstruction Filters in Computer Graphics,
/// 1988.)
[[nodiscard]] double weight(PixelFilter filter, double distance);

/// Samples sorted by the pixel that contains them.
class SampleGrid {
 public:
  /// Sorts samples that lie in an image of this size.
  SampleGrid(std::span<const Sample> samples, std::size_t width, std::size_t height);

  /// Calls visit(sample) for at least all samples with left <= x <= right and top <= y <= bottom.
  template <class Visit>
  void for_each_near(const Rectangle& area, const Visit& visit) const {
    const Range columns = range(area.left, area.right, width_);
    const Range rows = range(area.top, area.bottom, height_);
    for (std::size_t row = rows.first; row <= rows.last; ++row) {
      const std::size_t begin = starts_[row * width_ + columns.first];
      const std::size_t end = starts_[row * width_ + columns.last + 1];
      for (std::size_t i = begin; i < end; ++i) visit(sorted_[i]);
    }
  }

  [[nodiscard]] std::size_t size() const { return sorted_.size(); }

 private:
  struct Range {
    std::size_t first;
    std::size_t last;
  };
  static Range range(double low, double high, std::size_t size);

  std::size_t width_;
  std::size_t height_;
  std::vector<std::size_t> starts_;  // of each pixel in sorted_, and the end
  std::vector<Sample> sorted_;
};

/// What a filter finds around a position.
struct Gathered {
  double weight = 0;           ///< sum of the weights
  double absolute_weight = 0;  ///< sum of their magnitudes
  double squared_weight = 0;   ///< sum of their squares
  std::uint64_t count = 0;     ///< samples with a weight that is not 0
  double sum[3] = {};          ///< weighted sum of the radiances

  /// Whether the average is meaningful: there are samples, and negative weights do not nearly
  /// cancel the positive ones.
  [[nodiscard]] bool usable() const { return weight > 0 && weight >= 0.5 * absolute_weight; }
};

/// Sums the samples around (x, y) under a filter that is widened `width` times.
[[nodiscard]] Gathered gather(const SampleGrid& grid, PixelFilter filter, double width, double x,
                              double y);

/// How much wider than normal a filter must be for `rate` samples per pixel to give one sample in
/// the place of a pixel: 1 from one sample per pixel on, below that 1 / sqrt(rate).
[[nodiscard]] double width_for_rate(double rate);

/// Sets the pixels of a rendering to weighted averages of the samples (paper, section 3.1.2).
/// `widths` tells how much wider than normal the filter is: one number for each pixel, or a single
/// one for all. Where that finds no usable samples the filter is widened by steps of sqrt(2) until
/// it does. There must be at least one sample.
void weighted_average(std::span<const Sample> samples, PixelFilter filter,
                      std::span<const float> widths, Rendering& rendering);

}  // namespace baselines
