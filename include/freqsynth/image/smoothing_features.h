// SPDX-License-Identifier: MIT
/// \file
/// What guides the smoothing of noise beside the picture itself: features that blocks fit, and
/// those of which pixels keep means.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/pixel_store.h"
#include "freqsynth/image/noisy_picture.h"

namespace freqsynth {

/// The features of a picture, at one moment.
struct SmoothingFeatures {
  std::span<const std::size_t> fitted = {};  ///< channels of the blocks that have no weight
  const PixelStore* means = nullptr;         ///< all of its channels are averaged; null: none
};

namespace detail {

/// A feature of which pixels keep means, in a unit in which its values are at most 2. The planes
/// are those of a NoisyPicture: the cells of narrow blocks have the values of the pixels below
/// their centres.
struct MeanFeature {
  NoisyPicture::Plane means;      ///< of the samples in each pixel, or near it where there are none
  NoisyPicture::Plane pixels;     ///< the same, drawn to what is around: means over their areas
  NoisyPicture::Plane variances;  ///< of the samples, of each block, row by row
};

/// Where the values of a channel come from that are beside a pixel.
class MeansAround {
 public:
  MeansAround(const PixelStore& store, std::size_t channel) : store_(store), channel_(channel) {}

  /// The samples of a pixel.
  [[nodiscard]] PixelStore::Sum own(std::size_t x, std::size_t y) const {
    return store_.around(x, y, channel_, 0);
  }
  /// Those of the eight pixels around it.
  [[nodiscard]] PixelStore::Sum beside(std::size_t x, std::size_t y) const {
    const PixelStore::Sum all = store_.around(x, y, channel_, 1), inner = own(x, y);
    return {all.count - inner.count, all.sum - inner.sum};
  }

 private:
  const PixelStore& store_;
  std::size_t channel_;
};

/// \param doubt  see FinishSettings::doubt
inline MeanFeature mean_feature(const BlockGrid& grid, const PixelStore& store, std::size_t channel,
                                double doubt) {
  std::vector<float> means = store.pixels(channel);
  float largest = 0;
  for (const float mean : means) largest = std::max(largest, std::abs(mean));
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  const MeansAround around(store, channel);
  MeanFeature feature;
  const std::size_t width = grid.blocks_x * block_size;
  feature.means.resize(width * grid.blocks_y * block_size);
  feature.pixels.resize(feature.means.size());
  feature.variances.resize(grid.size());
  for (std::size_t block = 0; block < grid.size(); ++block) {
    const std::size_t left = grid.column(block) * block_size, top = grid.row(block) * block_size;
    double squares = 0, pairs = 0;
    for (std::size_t cell = 0; cell < max_terms; ++cell) {
      const std::size_t column = cell % block_size, row = cell / block_size;
      const std::size_t x = left + (2 * column + 1) * grid.block_width(block) / (2 * block_size);
      const std::size_t y = top + (2 * row + 1) * grid.block_height(block) / (2 * block_size);
      const auto scaled = [exponent](double value) { return std::ldexp(value, -exponent); };
      const PixelStore::Sum own = around.own(x, y), beside = around.beside(x, y);
      const double mean = scaled(double{means[y * grid.width + x]});
      double pixel = mean;
      if (own.count > 0 && beside.count > 0) {
        const double other = scaled(beside.sum / beside.count);
        pixel = (own.count * mean + doubt * other) / (own.count + doubt);
        // The difference of two means of samples that have the same one.
        squares += (mean - other) * (mean - other) / (1 / own.count + 1 / beside.count);
        pairs += 1;
      }
      const std::size_t at = (top + row) * width + left + column;
      feature.means[at] = static_cast<float>(mean);
      feature.pixels[at] = static_cast<float>(pixel);
    }
    feature.variances[block] = pairs > 0 ? static_cast<float>(squares / pairs) : 0;
  }
  return feature;
}

}  // namespace detail
}  // namespace freqsynth
