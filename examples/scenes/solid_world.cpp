// SPDX-License-Identifier: MIT
#include "solid_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace scenes {
namespace {

constexpr double kLift = 1e-6;
constexpr double kFar = std::numeric_limits<double>::infinity();

const Vec3 kToSun = normalize({-0.55, -0.45, 0.75});
constexpr Vec3 kSunlight{0.95, 0.88, 0.74};

Vec3 sky(const Vec3& direction) {
  constexpr Vec3 kHorizon{0.74, 0.80, 0.86};
  constexpr Vec3 kZenith{0.16, 0.34, 0.68};
  return mix(kHorizon, kZenith, std::sqrt(std::clamp(direction.z, 0.0, 1.0)));
}

Passage pass(const Solid& solid, const Ray& ray) {
  return std::visit([&](const auto& shape) { return shape.pass(ray); }, solid);
}

}  // namespace

SolidWorld::SolidWorld(const Floor& floor, std::vector<Part> parts)
    : floor_(floor), parts_(std::move(parts)) {}

std::optional<SolidWorld::Surface> SolidWorld::find(const Ray& ray) const {
  double nearest = ray.direction.z < 0.0 ? -ray.origin.z / ray.direction.z : kFar;
  Vec3 normal{0.0, 0.0, 1.0};
  const Part* met = nullptr;
  for (const Part& part : parts_) {
    const Passage passage = pass(part.solid, ray);
    if (passage.t0 > 0.0 && passage.t0 < passage.t1 && passage.t0 < nearest) {
      nearest = passage.t0;
      normal = passage.normal0;
      met = &part;
    }
  }
  if (nearest == kFar) return std::nullopt;

  const Vec3 p = ray.at(nearest);
  normal = normalize(normal);
  Vec3 color;
  if (met != nullptr) {
    color = met->color;
  } else {
    const double tile = std::floor(p.x / floor_.tile) + std::floor(p.y / floor_.tile);
    color = std::fmod(tile, 2.0) == 0.0 ? floor_.light : floor_.dark;
  }
  return Surface{nearest, p + kLift * normal, normal, color, met == nullptr};
}

bool SolidWorld::is_hidden(const Ray& ray, double distance) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    const Passage passage = pass(part.solid, ray);
    return passage.t0 > 0.0 && passage.t0 < passage.t1 && passage.t0 < distance;
  });
}

Vec3 SolidWorld::in_daylight(const Ray& ray) const { return in_daylight(ray, find(ray)); }

Vec3 SolidWorld::in_daylight(const Ray& ray, const std::optional<Surface>& surface) const {
  if (!surface) return sky(ray.direction);
  const Vec3& normal = surface->normal;
  const double openness = surface->is_floor ? 1.0 : 0.6 + 0.4 * normal.z;
  Vec3 light = 0.35 * openness * (surface->color * sky(normal));

  const double cosine = dot(normal, kToSun);
  if (cosine > 0.0 && !is_hidden({surface->point, kToSun}, kFar)) {
    light = light + cosine * (surface->color * kSunlight);
    if (!surface->is_floor) {
      const Vec3 half = normalize(kToSun - ray.direction);
      light = light + 2.0 * std::pow(std::max(dot(normal, half), 0.0), 200.0) * kSunlight;
    }
  }
  if (!surface->is_floor) return light;
  const double clear = std::exp(-surface->t * surface->t / (40.0 * 40.0));
  return mix(sky({}), light, clear);
}

}  // namespace scenes
