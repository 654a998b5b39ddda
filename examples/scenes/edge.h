// SPDX-License-Identifier: MIT
/// \file
/// The `edge` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// A straight edge between black (exactly 0, on the left) and white (exactly 1), 5 degrees off the
/// vertical: neighbouring rows of pixels see it at slightly different places, so that its profile
/// can be measured much finer than a pixel.
class Edge final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0. The edge passes left of the middle of the image: 43
  /// % of the area is black where it meets the top and the bottom.
  Edge(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

 private:
  double offset_;  // the edge's distance from the origin, in pixels
};

}  // namespace scenes
