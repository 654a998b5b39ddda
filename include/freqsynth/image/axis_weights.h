// SPDX-License-Identifier: MIT
/// \file
/// Resampling along one axis: what each frequency of a block is worth in each pixel of an output of
/// another size. Pixels at any resolution are these weights of both axes, applied to coefficients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/image/pixel_filter.h"

namespace freqsynth::detail {

/// The pixels of the output that one column (or row) of blocks contributes to.
struct AxisBlock {
  std::size_t first = 0;         ///< first output pixel
  std::size_t count = 0;         ///< how many
  std::size_t begun = 0;         ///< so many of the first ones have begun in earlier blocks
  AlignedVector<float> weights;  ///< of cos(pi u s) in each pixel
};

/// `count` rounded up to whole vectors of the kernel.
constexpr std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

/// The order in which weights lie in memory.
enum class WeightOrder : std::uint8_t {
  by_frequency,  ///< [u][padded(count)], for the columns of the kernel
  by_pixel       ///< [count][v], for its rows
};

/// Whether the filter is wider than its pixel, or may be: pixels are then made of several blocks.
[[nodiscard]] bool is_wide(PixelFilter filter, const PixelFilterShape& shape);

/// One axis of the output: `size` pixels of the image become `out` pixels.
[[nodiscard]] std::vector<AxisBlock> make_axis(std::size_t size, std::size_t out,
                                               PixelFilter filter, const PixelFilterShape& shape,
                                               WeightOrder order);

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/axis_weights.inl"
#endif
