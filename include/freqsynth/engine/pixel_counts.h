// SPDX-License-Identifier: MIT
/// \file
/// How many samples every pixel of an image has been asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// A counter for each pixel, row by row: two bytes, four once one of them needs more. Where the
/// grid is a part of a frame, pixels have their numbers in the frame, and those just beyond the
/// part's right and bottom border share the counters of its last pixels.
class PixelCounts {
 public:
  /// All are 0.
  explicit PixelCounts(const BlockGrid& grid)
      : covered_(grid.covered()),
        frame_width_(grid.whole().width),
        frame_height_(grid.whole().height),
        part_(grid.is_part()),
        narrow_(grid.width * grid.height) {}

  /// Number of the pixel that contains a point of the frame. The frame's right and bottom border
  /// belong to its last pixels.
  [[nodiscard]] std::size_t pixel(const BlockGrid::Point& point) const {
    const std::size_t x = std::min(static_cast<std::size_t>(point.x), frame_width_ - 1);
    const std::size_t y = std::min(static_cast<std::size_t>(point.y), frame_height_ - 1);
    return y * frame_width_ + x;
  }

  /// Hints that a sample of a pixel will be counted soon.
  void prefetch(std::size_t pixel) const {
#if defined(__GNUC__)
    if (wide_.empty()) __builtin_prefetch(narrow_.data() + place(pixel), 1);
#endif
  }

  /// Makes room, so that the next `more` calls of next() can count.
  void reserve(std::size_t more);

  /// Counts a sample of a pixel. \return how many it had before
  std::uint32_t next(std::size_t pixel) {
    const std::size_t at = place(pixel);
    if (!wide_.empty()) return wide_[at]++;
    const std::uint16_t before = narrow_[at]++;
    FREQSYNTH_ASSERT(before < most_narrow);
    if (before >= largest_) largest_ = before + std::size_t{1};
    return before;
  }

 private:
  friend struct StateArchive;

  static constexpr std::size_t most_narrow = std::numeric_limits<std::uint16_t>::max();

  /// Of a pixel's counter.
  [[nodiscard]] std::size_t place(std::size_t pixel) const {
    if (!part_) return pixel;
    const std::size_t x = std::min(pixel % frame_width_ - covered_.x, covered_.width - 1);
    const std::size_t y = std::min(pixel / frame_width_ - covered_.y, covered_.height - 1);
    return y * covered_.width + x;
  }

  PixelWindow covered_;
  std::size_t frame_width_, frame_height_;
  bool part_;
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
