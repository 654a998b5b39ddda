// SPDX-License-Identifier: MIT
/// \file
/// Vectors and rays, in double.
#pragma once

#include <cmath>
#include <span>

namespace scenes {

/// A point, a direction or a colour.
struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
/// Component by component, as light is filtered by a colour.
constexpr Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }

constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

/// The unit vector along `a`. A zero vector, as the gradient at the very tip of a cone, gives "up".
inline Vec3 normalize(const Vec3& a) {
  const double size = length(a);
  return size > 0.0 ? (1.0 / size) * a : Vec3{0.0, 0.0, 1.0};
}

/// Stores a colour as red, green and blue.
inline void store(const Vec3& color, std::span<float, 3> rgb) {
  rgb[0] = static_cast<float>(color.x);
  rgb[1] = static_cast<float>(color.y);
  rgb[2] = static_cast<float>(color.z);
}

/// From `a` at s = 0 to `b` at s = 1.
constexpr Vec3 mix(const Vec3& a, const Vec3& b, double s) { return (1.0 - s) * a + s * b; }

/// 0 up to `from`, 1 after `to`, and a smooth cubic in between.
constexpr double smoothstep(double from, double to, double x) {
  const double s = x <= from ? 0.0 : x >= to ? 1.0 : (x - from) / (to - from);
  return s * s * (3.0 - 2.0 * s);
}

/// A half line; `direction` has unit length, so that t is a distance.
struct Ray {
  Vec3 origin;
  Vec3 direction;

  [[nodiscard]] Vec3 at(double t) const { return origin + t * direction; }
};

/// A stretch of a ray; empty if t0 >= t1.
struct Interval {
  double t0 = 0.0;
  double t1 = 0.0;
};

/// The nearest crossing found so far. `normal` points out of the solid, its length is arbitrary.
struct Hit {
  double t = 0.0;
  Vec3 normal;
};

}  // namespace scenes
