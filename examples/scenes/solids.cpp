// SPDX-License-Identifier: MIT
#include "solids.h"

#include <cmath>
#include <limits>

namespace scenes {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Narrows `passage` to the slab |p| <= half along one axis, where p = o + t d.
void cut_to_slab(Passage& passage, double o, double d, double half, const Vec3& axis) {
  if (d == 0.0) {
    if (std::abs(o) > half) passage.t1 = -kFar;
    return;
  }
  const double side = d > 0.0 ? 1.0 : -1.0;
  const double in = (-side * half - o) / d;
  const double out = (side * half - o) / d;
  if (in > passage.t0) {
    passage.t0 = in;
    passage.normal0 = -side * axis;
  }
  if (out < passage.t1) {
    passage.t1 = out;
    passage.normal1 = side * axis;
  }
}

}  // namespace

Passage Ball::pass(const Ray& ray) const {
  const Vec3 o = ray.origin - center;
  const double b = dot(o, ray.direction);
  const double discriminant = b * b - dot(o, o) + radius * radius;
  if (discriminant <= 0.0) return {};
  const double root = std::sqrt(discriminant);
  const double t0 = -b - root;
  const double t1 = -b + root;
  return {t0, t1, o + t0 * ray.direction, o + t1 * ray.direction};
}

bool Ball::contains(const Vec3& p) const {
  const Vec3 o = p - center;
  return dot(o, o) < radius * radius;
}

Box::Box(const Vec3& center, const Vec3& half, double angle)
    : center_(center), half_(half), cos_(std::cos(angle)), sin_(std::sin(angle)) {}

Vec3 Box::to_box(const Vec3& v) const {
  return {cos_ * v.x - sin_ * v.z, v.y, sin_ * v.x + cos_ * v.z};
}

Vec3 Box::from_box(const Vec3& v) const {
  return {cos_ * v.x + sin_ * v.z, v.y, -sin_ * v.x + cos_ * v.z};
}

Passage Box::pass(const Ray& ray) const {
  const Vec3 o = to_box(ray.origin - center_);
  const Vec3 d = to_box(ray.direction);
  Passage passage{-kFar, kFar, {}, {}};
  cut_to_slab(passage, o.x, d.x, half_.x, {1.0, 0.0, 0.0});
  cut_to_slab(passage, o.y, d.y, half_.y, {0.0, 1.0, 0.0});
  cut_to_slab(passage, o.z, d.z, half_.z, {0.0, 0.0, 1.0});
  passage.normal0 = from_box(passage.normal0);
  passage.normal1 = from_box(passage.normal1);
  return passage;
}

bool Box::contains(const Vec3& p) const {
  const Vec3 q = to_box(p - center_);
  return std::abs(q.x) < half_.x && std::abs(q.y) < half_.y && std::abs(q.z) < half_.z;
}

Passage Cylinder::pass(const Ray& ray) const {
  const Vec3& o = ray.origin;
  const Vec3& d = ray.direction;
  Passage passage{-kFar, kFar, {}, {}};
  const double a = d.x * d.x + d.y * d.y;
  const double b = o.x * d.x + o.y * d.y;
  const double c = o.x * o.x + o.y * o.y - radius * radius;
  if (a > 0.0) {
    const double discriminant = b * b - a * c;
    if (discriminant <= 0.0) return {};
    const double root = std::sqrt(discriminant);
    passage.t0 = (-b - root) / a;
    passage.t1 = (-b + root) / a;
    passage.normal0 = {o.x + passage.t0 * d.x, o.y + passage.t0 * d.y, 0.0};
    passage.normal1 = {o.x + passage.t1 * d.x, o.y + passage.t1 * d.y, 0.0};
  } else if (c > 0.0) {
    return {};
  }
  cut_to_slab(passage, o.z - 0.5 * (z0 + z1), d.z, 0.5 * (z1 - z0), {0.0, 0.0, 1.0});
  return passage;
}

bool Cylinder::contains(const Vec3& p) const {
  return p.x * p.x + p.y * p.y < radius * radius && p.z > z0 && p.z < z1;
}

}  // namespace scenes
