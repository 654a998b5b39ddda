// SPDX-License-Identifier: MIT
/// \file
/// A pinhole camera.
#pragma once

#include <algorithm>

#include "vec3.h"

namespace scenes {

/// Turns positions of an image into rays. z is up.
class Camera {
 public:
  /// Looks from `eye` at `target`, which must not be above or below it. `half_field` is the tangent
  /// of half the field of view of the image's lesser side; `width` and `height` are in pixels, > 0.
  Camera(const Vec3& eye, const Vec3& target, double half_field, double width, double height)
      : eye_(eye) {
    const Vec3 forward = normalize(target - eye);
    right_ = normalize(cross(forward, {0.0, 0.0, 1.0}));
    up_ = cross(right_, forward);
    const double per_pixel = 2.0 * half_field / std::min(width, height);
    across_ = per_pixel * right_;
    down_ = -per_pixel * up_;
    corner_ = forward - 0.5 * width * across_ - 0.5 * height * down_;
  }

  [[nodiscard]] const Vec3& eye() const { return eye_; }
  /// Unit vectors in the image plane.
  [[nodiscard]] const Vec3& right() const { return right_; }
  [[nodiscard]] const Vec3& up() const { return up_; }

  /// From the eye to what the pixel position (x, y) shows at distance 1, measured along the line
  /// from the eye to the target.
  [[nodiscard]] Vec3 direction(double x, double y) const {
    return corner_ + x * across_ + y * down_;
  }
  [[nodiscard]] Ray ray(double x, double y) const { return {eye_, normalize(direction(x, y))}; }

 private:
  Vec3 eye_;
  Vec3 right_;
  Vec3 up_;
  Vec3 corner_;  // direction through the image's top left corner
  Vec3 across_;  // added per pixel to the right
  Vec3 down_;    // added per pixel downwards
};

}  // namespace scenes
