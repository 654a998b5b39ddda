// SPDX-License-Identifier: MIT
#include "soft_shadow.h"

#include <numbers>

namespace scenes {
namespace {

constexpr Vec3 kEye{1.5, -8.5, 4.6};
constexpr Vec3 kTarget{0.15, 0.2, 0.75};
constexpr double kHalfField = 0.33;

// A horizontal square that shines downwards.
constexpr Vec3 kLampMiddle{-3.9, -0.3, 4.4};
constexpr double kLampSide = 1.6;
constexpr Vec3 kLampRadiance{56.0, 50.0, 40.0};

constexpr Vec3 kAmbient{0.045, 0.055, 0.075};

SolidWorld make_world() {
  return {{{0.72, 0.70, 0.66}, {0.56, 0.55, 0.53}, 1.0},
          {
              {Ball{{-1.5, 0.3, 0.9}, 0.9}, {0.75, 0.16, 0.10}},
              {Box{{1.75, 0.9, 0.7}, {0.6, 0.6, 0.7}}, {0.14, 0.38, 0.62}},
              {Ball{{0.75, -1.7, 0.4}, 0.4}, {0.80, 0.62, 0.12}},
              {Cylinder{0.09, 0.0, 2.5}, {0.65, 0.65, 0.65}},
          }};
}

}  // namespace

SoftShadow::SoftShadow(int width, int height, std::uint64_t seed)
    : NoisyWorld(make_world(), Camera(kEye, kTarget, kHalfField, width, height), seed) {}

NoisyWorld::View SoftShadow::look(double x, double y, std::uint64_t id) const {
  const auto surface = world_.find(camera_.ray(x, y));
  if (!surface) return {kAmbient, surface};
  const freqsynth::OwenSobol chance = decision(id);
  const double across = kLampSide * (chance(0) - 0.5);
  const double along = kLampSide * (chance(1) - 0.5);
  const Vec3 path = kLampMiddle + Vec3{across, along, 0.0} - surface->point;
  const double distance = length(path);
  const Vec3 to_lamp = (1.0 / distance) * path;

  Vec3 light = kAmbient;
  const double at_surface = dot(surface->normal, to_lamp);
  const double at_lamp = to_lamp.z;
  if (at_surface > 0.0 && at_lamp > 0.0 && !world_.is_hidden({surface->point, to_lamp}, distance)) {
    const double area = kLampSide * kLampSide;
    const double share = area * at_surface * at_lamp / (std::numbers::pi * distance * distance);
    light = light + share * kLampRadiance;
  }
  return {surface->color * light, surface};
}

}  // namespace scenes
