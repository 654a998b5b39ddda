// SPDX-License-Identifier: MIT
/// \file
/// The `star` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// A Siemens star: 37 black (exactly 0) spokes on white (exactly 1), with hard edges in all
/// directions. Every frequency occurs, in every direction: the spokes have 37 / (2 pi r) cycles per
/// pixel at r pixels from their centre, which lies near that of the image. The number is odd, so
/// that opposite spokes differ.
class Star final : public Scene {
 public:
  /// A star that almost touches the lesser side of `width` by `height` pixels, both > 0.
  Star(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

 private:
  double center_x_;
  double center_y_;
  double square_radius_;
};

}  // namespace scenes
