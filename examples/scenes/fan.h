// SPDX-License-Identifier: MIT
/// \file
/// The `fan` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// The resolution fan: 15.5 pairs of hard-edged lines, black (exactly 0) and white (exactly 1),
/// that converge from the top of a white image to its bottom.
///
/// Defined in unit coordinates, so it looks the same at every size, and the frequencies (in cycles
/// per pixel) scale with 1 / width. In an image 512 pixels wide a pair of lines is about 28 pixels
/// wide at the top and 2 pixels wide at the bottom, where a sample per pixel can no longer resolve
/// it.
class Fan final : public Scene {
 public:
  /// A fan that fills `width` by `height` pixels, both > 0, but for a margin.
  Fan(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

 private:
  double unit_per_pixel_x_;
  double unit_per_pixel_y_;
};

}  // namespace scenes
