// SPDX-License-Identifier: MIT
#include "scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace path_tracer {

double mirrored_share(double cosine, double ratio) {
  const double sine2 = ratio * ratio * (1 - cosine * cosine);  // on the other side (Snell)
  if (sine2 >= 1) return 1;
  const double other = std::sqrt(1 - sine2);
  const double parallel = (cosine - ratio * other) / (cosine + ratio * other);
  const double crossed = (ratio * cosine - other) / (ratio * cosine + other);
  return 0.5 * (parallel * parallel + crossed * crossed);
}

Vec3 diffuse_direction(const Vec3& normal, const std::array<double, 2>& chance) {
  const double radius = std::sqrt(chance[0]);
  const double angle = 2 * std::numbers::pi * chance[1];
  const Vec3 other = std::abs(normal.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 u = normalize(cross(normal, other));
  const Vec3 v = cross(normal, u);
  return normalize(radius * std::cos(angle) * u + radius * std::sin(angle) * v +
                   std::sqrt(std::max(0.0, 1 - chance[0])) * normal);
}

Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
  return normalize(direction - 2 * dot(direction, normal) * normal);
}

Vec3 glass_direction(const Vec3& direction, const Vec3& normal, double chance) {
  const bool enters = dot(direction, normal) < 0;
  const Vec3 facing = enters ? normal : -normal;
  const double ratio = enters ? 1 / glass_index : glass_index;
  const double cosine = std::min(1.0, -dot(direction, facing));
  if (chance < mirrored_share(cosine, ratio)) return mirrored(direction, normal);
  const Vec3 along = ratio * (direction + cosine * facing);
  return normalize(along - std::sqrt(std::max(0.0, 1 - dot(along, along))) * facing);
}

}  // namespace path_tracer
