// SPDX-License-Identifier: MIT
/// \file
/// A picture with Monte Carlo noise: what the samples have said of each pixel, and what is made of
/// it.
#pragma once

#include <cstddef>
#include <vector>

#include "freqsynth/basis/large_pages.h"

namespace freqsynth {

/// Whole blocks of pixels, which are smoothed in any unit.
struct NoisyPicture {
  /// Values of pixels, row by row.
  using Plane = detail::LargeVector<float>;

  std::size_t width = 0;      ///< pixels, a multiple of block_size
  std::size_t height = 0;     ///< pixels, a multiple of block_size
  Plane weights;              ///< samples of each pixel, not negative
  std::vector<Plane> sums;    ///< of each channel: sum of the samples, by the same weights
  std::vector<Plane> pixels;  ///< of each channel: the finished pixels
  /// Of each channel: the variance of the samples of each block about its fit, blocks row by row.
  std::vector<Plane> variances;
  std::vector<std::size_t> seamless;  ///< channels whose pixels are not made block by block
};

}  // namespace freqsynth
