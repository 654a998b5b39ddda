// SPDX-License-Identifier: MIT
#include "checker.h"

#include <cmath>

namespace scenes {
namespace {

// The rows of squares run off at an angle: no edge is parallel to the rows of pixels.
constexpr Vec3 kEye{0.0, 0.0, 1.0};
constexpr Vec3 kTarget{1.3, 3.0, 0.55};
constexpr double kHalfField = 0.5;

constexpr Vec3 kLight{0.86, 0.80, 0.68};
constexpr Vec3 kDark{0.035, 0.050, 0.090};

Vec3 sky(const Vec3& direction) {
  constexpr Vec3 kHorizon{0.60, 0.72, 0.85};
  constexpr Vec3 kAbove{0.16, 0.33, 0.68};
  return mix(kHorizon, kAbove, smoothstep(0.0, 0.5, direction.z));
}

}  // namespace

Checker::Checker(int width, int height) : camera_(kEye, kTarget, kHalfField, width, height) {}

void Checker::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const Vec3 direction = camera_.ray(x, y).direction;
  if (direction.z >= 0.0) {
    store(sky(direction), rgb);
    return;
  }
  const double distance = -kEye.z / direction.z;
  const double square =
      std::floor(kEye.x + distance * direction.x) + std::floor(kEye.y + distance * direction.y);
  store(std::fmod(square, 2.0) == 0.0 ? kLight : kDark, rgb);
}

}  // namespace scenes
