// SPDX-License-Identifier: MIT
/// \file
/// Resampling along one axis: what each frequency of a block is worth in each pixel of an output of
/// another size. Pixels at any resolution are these weights of both axes, applied to coefficients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// What a pixel's value is.
enum class PixelFilter : std::uint8_t {
  none,  ///< the function's value at the pixel's centre
  box    ///< its exact average over the pixel's area
};

namespace detail {

/// The pixels of the output that one column (or row) of blocks contributes to.
struct AxisBlock {
  std::size_t first = 0;       ///< first output pixel
  std::size_t count = 0;       ///< how many
  bool continues = false;      ///< the first one began in the previous block
  std::vector<float> weights;  ///< of cos(pi u s) in each pixel
};

/// `count` rounded up to whole vectors of the kernel.
constexpr std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

/// The order in which weights lie in memory.
enum class WeightOrder : std::uint8_t {
  by_frequency,  ///< [u][padded(count)], for the columns of the kernel
  by_pixel       ///< [count][v], for its rows
};

/// One axis of the output: `size` pixels of the image become `out` pixels.
[[nodiscard]] std::vector<AxisBlock> make_axis(std::size_t size, std::size_t out,
                                               PixelFilter filter, WeightOrder order);

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/axis_weights.inl"
#endif
