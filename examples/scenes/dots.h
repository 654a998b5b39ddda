// SPDX-License-Identifier: MIT
/// \file
/// The `dot` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// Bright discs of 0.3 pixels radius on mid gray, at irregular positions with many pixels between
/// them: a point sample in their pixel hits one with a chance of 28 %, elsewhere never. A picture
/// shows whether a sampler finds them, and whether it gives them the energy that they have.
class Dots final : public Scene {
 public:
  static constexpr double kRadius = 0.3;       ///< pixels, at every size of the image
  static constexpr double kBackground = 0.18;  ///< radiance
  static constexpr double kBrightness = 3.0;   ///< radiance of a dot: its pixel averages about 1

  /// `width` and `height` in pixels, both > 0. There are up to 7 x 7 dots, fewer in an image that
  /// is too small to keep them apart.
  Dots(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

  [[nodiscard]] int count() const { return columns_ * rows_; }

 private:
  struct Position {
    double x, y;
  };

  /// The only dot near (x, y), if any is.
  [[nodiscard]] Position dot_near(double x, double y) const;

  int columns_;
  int rows_;
  double cell_width_;
  double cell_height_;
};

}  // namespace scenes
