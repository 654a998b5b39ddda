// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/image/pixel_view.h"

namespace freqsynth {
namespace detail {

/// Refuses strides that are certain to put two values in one place, and leaves it to the caller
/// where that would take a search.
inline void check_strides(const PixelView& view, std::size_t channels) {
  struct Stride {
    const char* name;
    std::ptrdiff_t floats;
    std::size_t steps;
  };
  const Stride strides[] = {{"channel_stride", view.channel_stride, channels},
                            {"pixel_stride", view.pixel_stride, view.width},
                            {"row_stride", view.row_stride, view.height}};
  for (const Stride& a : strides) {
    if (a.steps < 2) continue;
    if (a.floats == 0) refuse(std::string("a view's ") + a.name + " is 0");
    for (const Stride& b : strides) {
      if (&a == &b || b.steps < 2 || (a.floats != b.floats && a.floats != -b.floats)) continue;
      refuse(std::string("a view's ") + a.name + " is " + std::to_string(a.floats) + ", its " +
             b.name + " " + std::to_string(b.floats) + ": values would share memory");
    }
  }
}

}  // namespace detail

FREQSYNTH_INLINE PixelView PixelView::resolved(std::size_t channels) const {
  PixelView view = *this;
  if (width == 0 || height == 0) return view;
  if (data == nullptr) {
    detail::refuse("no memory for " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels");
  }
  const auto length = [](std::ptrdiff_t stride) {
    return static_cast<std::size_t>(stride < 0 ? -stride : stride);
  };
  // Of one channel the stride says nothing.
  const std::size_t channel = channels == 1 ? 1 : length(channel_stride);
  if (pixel_stride == 0) {
    view.pixel_stride = static_cast<std::ptrdiff_t>(channel >= width ? 1 : channels * channel);
  }
  if (row_stride == 0) {
    const std::size_t row = width * length(view.pixel_stride);
    const bool row_by_row = channels > 1 && channel >= row && channel < row * height;
    view.row_stride = static_cast<std::ptrdiff_t>(row_by_row ? channels * channel : row);
  }
  detail::check_strides(view, channels);
  return view;
}

}  // namespace freqsynth
