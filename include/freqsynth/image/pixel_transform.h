// SPDX-License-Identifier: MIT
/// \file
/// The way back from pixels to a frequency image (paper, section 2, eq. 1), with the narrow blocks
/// at the image's right and lower border.
#pragma once

#include <cstddef>
#include <span>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/frequency_image.h"

namespace freqsynth {

/// The frequency image of finished pixels (CoefficientMeaning::pixel_average), of which
/// reconstruct() with the box filter makes the same pixels at the image's own size. Sample counts
/// are 0. A block has as many frequencies as it has pixels along each axis.
/// \param pixels  row by row, channels interleaved
/// \throws std::invalid_argument when there are not width * height * channels values, channels is
///         0, or the size overflows.
[[nodiscard]] FREQSYNTH_API FrequencyImage transform_pixels(std::span<const float> pixels,
                                                            std::size_t width, std::size_t height,
                                                            std::size_t channels);

namespace detail {

/// Eq. 1 for a block of width x height (each 1..8) pixels; for 8 x 8 it is forward_dct(). Writes
/// the coefficients of the block's cells, see CoefficientMeaning::pixel_average.
/// \param pixels  rows of 8, of which the first `width` values and the first `height` rows count
FREQSYNTH_API void transform_block(std::span<const float, max_terms> pixels, std::size_t width,
                                   std::size_t height, std::span<float, max_terms> coefficients);

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/pixel_transform.inl"
#endif
