// SPDX-License-Identifier: MIT
/// \file
/// The `gradient` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// Slow waves of colour in several directions, about one cycle per image or less: no edge anywhere,
/// so that every step in a picture of it is a fault.
class Gradient final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0.
  Gradient(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

 private:
  double unit_per_pixel_x_;
  double unit_per_pixel_y_;
};

}  // namespace scenes
