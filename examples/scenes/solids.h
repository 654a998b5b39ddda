// SPDX-License-Identifier: MIT
/// \file
/// Simple convex solids.
#pragma once

#include <variant>

#include "vec3.h"

namespace scenes {

/// Where a ray enters (0) and leaves (1) a convex solid. Not crossed at all if t0 >= t1. The
/// normals point outwards; their length is arbitrary.
struct Passage {
  double t0 = 0.0;
  double t1 = 0.0;
  Vec3 normal0;
  Vec3 normal1;
};

struct Ball {
  Vec3 center;
  double radius;

  [[nodiscard]] Passage pass(const Ray& ray) const;
  [[nodiscard]] bool contains(const Vec3& p) const;
};

/// A box, turned by an angle about an axis through its centre that is parallel to y.
class Box {
 public:
  /// `half` are half the edge lengths. A positive angle (radians) turns z towards x.
  Box(const Vec3& center, const Vec3& half, double angle = 0.0);

  [[nodiscard]] Passage pass(const Ray& ray) const;
  [[nodiscard]] bool contains(const Vec3& p) const;

 private:
  [[nodiscard]] Vec3 to_box(const Vec3& v) const;
  [[nodiscard]] Vec3 from_box(const Vec3& v) const;

  Vec3 center_;
  Vec3 half_;
  double cos_;
  double sin_;
};

/// An upright cylinder about the z axis.
struct Cylinder {
  double radius;
  double z0;
  double z1;

  [[nodiscard]] Passage pass(const Ray& ray) const;
  [[nodiscard]] bool contains(const Vec3& p) const;
};

using Solid = std::variant<Ball, Box, Cylinder>;

}  // namespace scenes
