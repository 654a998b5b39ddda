// SPDX-License-Identifier: MIT
#include "sun.h"

#include <algorithm>
#include <cmath>

#include "random.h"
#include "vec3.h"

namespace scenes {
namespace {

constexpr double kSunX = 0.135;  // from the middle
constexpr double kSunY = 0.638;  // from the top
constexpr double kSunRadius = 0.035;
constexpr Vec3 kSunColor{1000.0, 920.0, 760.0};

// The height of the hills' line, measured from the top.
double hills(double u) {
  return 0.75 + 0.045 * std::sin(4.1 * u + 0.6) + 0.018 * std::sin(11.3 * u + 2.0);
}

// Whether a fir covers (u, v): a slender triangle with three tiers of branches.
bool is_fir(double u, double v) {
  constexpr double kSpacing = 0.043;
  const double number = std::floor(u / kSpacing);
  for (const double fir : {number - 1.0, number, number + 1.0}) {
    Random random(/*seed=*/3, static_cast<std::uint64_t>(static_cast<std::int64_t>(fir)));
    const double x = (fir + random.uniform()) * kSpacing;
    const double height = 0.05 + 0.12 * random.uniform();
    const double below_tip = (v - (hills(x) - height)) / height;
    if (below_tip < 0.0 || below_tip > 1.2) continue;
    const double tier = 3.0 * below_tip;
    const double reach = 0.10 * height * (0.5 * (tier - std::floor(tier)) + below_tip);
    if (std::abs(u - x) < reach) return true;
  }
  return false;
}

Vec3 sky(double u, double v) {
  constexpr Vec3 kZenith{0.06, 0.13, 0.34};
  constexpr Vec3 kHorizon{0.85, 0.42, 0.20};
  constexpr Vec3 kGlow{2.2, 1.25, 0.45};
  const double from_sun = std::hypot(u - kSunX, v - kSunY);
  return mix(kZenith, kHorizon, smoothstep(-0.1, 0.8, v)) + std::exp(-9.0 * from_sun) * kGlow;
}

}  // namespace

Sun::Sun(int width, int height) : unit_(1.0 / std::min(width, height)), middle_(0.5 * width) {}

void Sun::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double u = (x - middle_) * unit_;
  const double v = y * unit_;
  if (v > hills(u) || is_fir(u, v)) {
    constexpr Vec3 kFar{0.016, 0.012, 0.016};
    constexpr Vec3 kNear{0.004, 0.005, 0.007};
    store(mix(kFar, kNear, smoothstep(0.6, 1.0, v)), rgb);
  } else if (std::hypot(u - kSunX, v - kSunY) < kSunRadius) {
    store(kSunColor, rgb);
  } else {
    store(sky(u, v), rgb);
  }
}

}  // namespace scenes
