// SPDX-License-Identifier: MIT
#include "depth_of_field.h"

#include <cmath>
#include <numbers>

namespace scenes {
namespace {

constexpr Vec3 kEye{0.0, -8.0, 1.9};
constexpr Vec3 kTarget{0.25, 0.0, 0.75};
constexpr double kHalfField = 0.36;
constexpr double kLensRadius = 0.16;
constexpr Vec3 kInFocus{-0.65, -2.1, 0.6};
const double kFocalDistance = dot(kInFocus - kEye, normalize(kTarget - kEye));

SolidWorld make_world() {
  return {{{0.78, 0.75, 0.70}, {0.10, 0.11, 0.14}, 0.8},
          {
              {Ball{{-1.05, -4.6, 0.6}, 0.6}, {0.85, 0.55, 0.10}},
              {Ball{kInFocus, 0.6}, {0.72, 0.08, 0.08}},
              {Ball{{0.55, 0.6, 0.6}, 0.6}, {0.10, 0.50, 0.18}},
              {Ball{{2.3, 3.6, 0.6}, 0.6}, {0.10, 0.25, 0.70}},
              {Ball{{4.6, 7.4, 0.6}, 0.6}, {0.55, 0.18, 0.60}},
          }};
}

}  // namespace

DepthOfField::DepthOfField(int width, int height, std::uint64_t seed)
    : NoisyWorld(make_world(), Camera(kEye, kTarget, kHalfField, width, height), seed) {}

NoisyWorld::View DepthOfField::look(double x, double y, std::uint64_t id) const {
  // All rays of a pixel position meet in the plane that is in focus.
  const Vec3 meeting = camera_.eye() + kFocalDistance * camera_.direction(x, y);

  const freqsynth::OwenSobol chance = decision(id);
  const double radius = kLensRadius * std::sqrt(chance(0));
  const double angle = 2.0 * std::numbers::pi * chance(1);
  const Vec3 on_lens = camera_.eye() + radius * std::cos(angle) * camera_.right() +
                       radius * std::sin(angle) * camera_.up();
  const Ray ray{on_lens, normalize(meeting - on_lens)};
  const auto surface = world_.find(ray);
  return {world_.in_daylight(ray, surface), surface};
}

}  // namespace scenes
