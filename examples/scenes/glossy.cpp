// SPDX-License-Identifier: MIT
#include "glossy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scenes {
namespace {

constexpr Vec3 kEye{-1.2, -8.0, 2.3};
constexpr Vec3 kTarget{0.1, 0.0, 0.55};
constexpr double kHalfField = 0.34;

struct Finish {
  double straight;   // share that is mirrored when seen straight on
  double sharpness;  // exponent of the cosine lobe about the mirror direction
};
constexpr Finish kFloor{0.35, 150.0};
constexpr Finish kSolid{0.05, 1500.0};

SolidWorld make_world() {
  return {{{0.42, 0.40, 0.38}, {0.20, 0.19, 0.20}, 1.5},
          {
              {Ball{{-1.5, 0.2, 0.85}, 0.85}, {0.80, 0.10, 0.06}},
              {Box{{0.55, 1.6, 0.9}, {0.5, 0.5, 0.9}}, {0.10, 0.42, 0.55}},
              {Ball{{1.75, -0.1, 0.65}, 0.65}, {0.82, 0.58, 0.08}},
              {Ball{{0.2, -1.5, 0.35}, 0.35}, {0.16, 0.50, 0.12}},
          }};
}

// A direction about the unit vector `axis`, with a density that grows as cos^exponent.
Vec3 random_about(const Vec3& axis, double exponent, const freqsynth::OwenSobol& chance) {
  const double cosine = std::pow(chance(0), 1.0 / (exponent + 1.0));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double angle = 2.0 * std::numbers::pi * chance(1);
  const Vec3 other = std::abs(axis.z) < 0.9 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
  const Vec3 u = normalize(cross(axis, other));
  const Vec3 v = cross(axis, u);
  return cosine * axis + sine * (std::cos(angle) * u + std::sin(angle) * v);
}

}  // namespace

Glossy::Glossy(int width, int height, std::uint64_t seed)
    : NoisyWorld(make_world(), Camera(kEye, kTarget, kHalfField, width, height), seed) {}

NoisyWorld::View Glossy::look(double x, double y, std::uint64_t id) const {
  const Ray ray = camera_.ray(x, y);
  const auto surface = world_.find(ray);
  const Vec3 scattered = world_.in_daylight(ray, surface);
  if (!surface) return {scattered, surface};
  const Vec3& normal = surface->normal;
  const Finish& finish = surface->is_floor ? kFloor : kSolid;
  const double cosine = std::clamp(-dot(normal, ray.direction), 0.0, 1.0);

  const Vec3 mirror = normalize(ray.direction + 2.0 * cosine * normal);
  Vec3 direction = random_about(mirror, finish.sharpness, decision(id));
  // The part of the lobe that would be below the surface is folded up.
  const double below = std::min(dot(normal, direction), 0.0);
  direction = normalize(direction - 2.0 * below * normal);

  // Schlick (1994).
  const double mirrored = finish.straight + (1.0 - finish.straight) * std::pow(1.0 - cosine, 5.0);
  const Vec3 reflected = world_.in_daylight({surface->point, direction});
  return {mix(scattered, reflected, mirrored), surface};
}

}  // namespace scenes
