// SPDX-License-Identifier: MIT
/// \file
/// What the scenes are made of.
#pragma once

#include <cmath>
#include <cstdint>

#include "scenes/vec3.h"

namespace path_tracer {

using scenes::Ray;
using scenes::Vec3;

/// How a surface scatters light.
enum class Scattering : std::uint8_t { diffuse, mirror, glass };

/// What a surface is made of.
struct Material {
  Vec3 colour{0.7, 0.7, 0.7};  ///< share of the light that is scattered, in 0..1; of glass 1
  Scattering scattering = Scattering::diffuse;
  Vec3 emission{0, 0, 0};  ///< radiance of the front side
};

/// Nearer than that a ray does not meet what it starts from.
inline constexpr double least_distance = 1e-7;

/// A ball, on its way while the shutter is open.
struct Sphere {
  Vec3 centre;  ///< when it opens, time 0
  double radius = 1;
  Vec3 motion{0, 0, 0};  ///< until it closes, time 1
  Material material;

  /// Distance to the nearest crossing that is nearer than `most`, else `most`.
  [[nodiscard]] double nearest(const Ray& ray, double time, double most) const {
    const Vec3 from = ray.origin - centre - time * motion;
    const double half = dot(from, ray.direction);
    const double square = half * half - dot(from, from) + radius * radius;
    if (square <= 0) return most;
    const double root = std::sqrt(square);
    for (const double t : {-half - root, -half + root}) {
      if (t > least_distance && t < most) return t;
    }
    return most;
  }
  /// Unit vector outwards.
  [[nodiscard]] Vec3 normal(const Vec3& point, double time) const {
    return normalize(point - centre - time * motion);
  }
};

/// A rectangle; cross(across, up) points to its front.
struct Rectangle {
  Vec3 corner;
  Vec3 across;  ///< one edge
  Vec3 up;      ///< the other edge, at a right angle
  Material material;

  /// Distance to the crossing if it is nearer than `most`, else `most`.
  [[nodiscard]] double nearest(const Ray& ray, double most) const {
    const Vec3 front = cross(across, up);
    const double slope = dot(front, ray.direction);
    if (slope == 0) return most;
    const double t = dot(front, corner - ray.origin) / slope;
    if (t <= least_distance || t >= most) return most;
    const Vec3 place = ray.at(t) - corner;
    const double u = dot(place, across), v = dot(place, up);
    const bool inside = u >= 0 && u <= dot(across, across) && v >= 0 && v <= dot(up, up);
    return inside ? t : most;
  }
  /// Unit vector to the front.
  [[nodiscard]] Vec3 normal() const { return normalize(cross(across, up)); }
  [[nodiscard]] double area() const { return length(cross(across, up)); }
};

}  // namespace path_tracer
