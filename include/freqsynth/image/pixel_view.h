// SPDX-License-Identifier: MIT
/// \file
/// An image in the caller's own memory.
#pragma once

#include <cstddef>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Memory for an image, the caller's own. Strides count floats and may be negative; those of pixels
/// and rows may be left at 0 for memory without gaps, in whatever order the channel stride says:
///   {data, width, height}                         the channels of a pixel side by side;
///   {data, width, height, 0, 0, width}            a row of one channel, then of the next;
///   {data, width, height, 0, 0, width * height}   one channel, then the next.
struct PixelView {
  float* data = nullptr;              ///< channel 0 of the pixel in the top left corner
  std::size_t width = 0;              ///< pixels in a row
  std::size_t height = 0;             ///< pixels in a column
  std::ptrdiff_t pixel_stride = 0;    ///< from a pixel to the one on its right
  std::ptrdiff_t row_stride = 0;      ///< from a pixel to the one below
  std::ptrdiff_t channel_stride = 1;  ///< from a channel to the next

  /// The view of an image of `channels` channels with its strides written out.
  /// \throws std::invalid_argument when there are pixels and no memory, or naming the strides when
  ///         they put two values in one place: a channel stride of 0, or two strides of one length.
  [[nodiscard]] FREQSYNTH_API PixelView resolved(std::size_t channels) const;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/pixel_view.inl"
#endif
