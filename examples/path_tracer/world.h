// SPDX-License-Identifier: MIT
/// \file
/// All surfaces of a scene, and what a ray meets of them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapes.h"

namespace path_tracer {

/// Where a ray meets a surface.
struct Surface {
  double distance = 0;
  Vec3 point;
  Vec3 normal;  ///< outwards, or to the front; unit length
  const Material* material = nullptr;
};

/// Surfaces under a sky. Lights are the rectangles that emit.
class World {
 public:
  Vec3 horizon{0, 0, 0};  ///< radiance of the sky there
  Vec3 zenith{0, 0, 0};   ///< and straight up and down

  void add(const Sphere& sphere) { spheres_.push_back(sphere); }
  void add(const Rectangle& rectangle);
  /// A box that stands upright on its middle, turned by an angle about it.
  void add_box(const Vec3& foot, const Vec3& size, double angle, const Material& material);

  /// The first surface along a ray.
  [[nodiscard]] std::optional<Surface> find(const Ray& ray, double time) const;
  /// Whether something is on a ray before a distance.
  [[nodiscard]] bool is_hidden(const Ray& ray, double time, double distance) const;
  /// Radiance from a direction in which there is nothing.
  [[nodiscard]] Vec3 sky(const Vec3& direction) const;

  [[nodiscard]] std::size_t lights() const { return lights_.size(); }
  [[nodiscard]] const Rectangle& light(std::size_t index) const {
    return rectangles_[lights_[index]];
  }

 private:
  std::vector<Sphere> spheres_;
  std::vector<Rectangle> rectangles_;
  std::vector<std::size_t> lights_;  // among the rectangles
};

}  // namespace path_tracer
