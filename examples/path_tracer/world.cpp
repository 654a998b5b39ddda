// SPDX-License-Identifier: MIT
#include "world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace path_tracer {

void World::add(const Rectangle& rectangle) {
  const Vec3& light = rectangle.material.emission;
  if (std::max({light.x, light.y, light.z}) > 0) lights_.push_back(rectangles_.size());
  rectangles_.push_back(rectangle);
}

void World::add_box(const Vec3& foot, const Vec3& size, double angle, const Material& material) {
  const Vec3 x = size.x * Vec3{std::cos(angle), std::sin(angle), 0};
  const Vec3 y = size.y * Vec3{-std::sin(angle), std::cos(angle), 0};
  const Vec3 z{0, 0, size.z};
  const Vec3 near = foot - 0.5 * x - 0.5 * y;  // the corner from which all edges go
  const Vec3 far = near + x + y + z;
  for (const auto& [a, b] : {std::pair{x, z}, std::pair{z, y}, std::pair{y, x}}) {
    add(Rectangle{near, a, b, material});
    add(Rectangle{far, -a, -b, material});
    std::swap(rectangles_.back().across, rectangles_.back().up);
  }
}

std::optional<Surface> World::find(const Ray& ray, double time) const {
  double nearest = std::numeric_limits<double>::infinity();
  const Sphere* sphere = nullptr;
  const Rectangle* rectangle = nullptr;
  for (const Sphere& each : spheres_) {
    const double t = each.nearest(ray, time, nearest);
    if (t < nearest) sphere = &each;
    nearest = t;
  }
  for (const Rectangle& each : rectangles_) {
    const double t = each.nearest(ray, nearest);
    if (t < nearest) rectangle = &each;
    nearest = t;
  }
  if (sphere == nullptr && rectangle == nullptr) return std::nullopt;
  const Vec3 point = ray.at(nearest);
  if (rectangle != nullptr) {
    return Surface{nearest, point, rectangle->normal(), &rectangle->material};
  }
  return Surface{nearest, point, sphere->normal(point, time), &sphere->material};
}

bool World::is_hidden(const Ray& ray, double time, double distance) const {
  return std::any_of(
             spheres_.begin(), spheres_.end(),
             [&](const Sphere& each) { return each.nearest(ray, time, distance) < distance; }) ||
         std::any_of(rectangles_.begin(), rectangles_.end(),
                     [&](const Rectangle& each) { return each.nearest(ray, distance) < distance; });
}

Vec3 World::sky(const Vec3& direction) const {
  return mix(horizon, zenith, std::sqrt(std::abs(direction.z)));
}

}  // namespace path_tracer
