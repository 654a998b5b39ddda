// SPDX-License-Identifier: MIT
/// \file
/// How many samples every pixel of an image has been asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// A counter for each pixel, row by row: two bytes, four once one of them needs more.
class PixelCounts {
 public:
  /// All are 0.
  explicit PixelCounts(const BlockGrid& grid)
      : width_(grid.width), height_(grid.height), narrow_(width_ * height_) {}

  /// Number of the pixel that contains a point of the image. The image's right and bottom border
  /// belong to its last pixels.
  [[nodiscard]] std::size_t pixel(const BlockGrid::Point& point) const {
    const auto x = static_cast<std::size_t>(point.x);
    const auto y = static_cast<std::size_t>(point.y);
    return (y < height_ ? y : height_ - 1) * width_ + (x < width_ ? x : width_ - 1);
  }

  /// Hints that a sample of a pixel will be counted soon.
  void prefetch(std::size_t pixel) const {
#if defined(__GNUC__)
    if (wide_.empty()) __builtin_prefetch(narrow_.data() + pixel, 1);
#endif
  }

  /// Makes room, so that the next `more` calls of next() can count.
  void reserve(std::size_t more);

  /// Counts a sample of a pixel. \return how many it had before
  std::uint32_t next(std::size_t pixel) {
    if (!wide_.empty()) return wide_[pixel]++;
    const std::uint16_t before = narrow_[pixel]++;
    FREQSYNTH_ASSERT(before < most_narrow);
    if (before >= largest_) largest_ = before + std::size_t{1};
    return before;
  }

 private:
  static constexpr std::size_t most_narrow = std::numeric_limits<std::uint16_t>::max();

  std::size_t width_, height_;
  std::size_t largest_ = 0;  // of the narrow counters
  std::vector<std::uint16_t> narrow_;
  std::vector<std::uint32_t> wide_;
};

// ------------------------------------------------------------------------------------ definitions

inline void PixelCounts::reserve(std::size_t more) {
  if (!wide_.empty() || narrow_.empty() || more <= most_narrow - largest_) return;
  wide_.assign(narrow_.begin(), narrow_.end());
  narrow_ = {};
}

}  // namespace freqsynth
