// SPDX-License-Identifier: MIT
#include "horse_head.h"

#include <algorithm>

namespace scenes::chess {
namespace {

// Everything is carved with y stretched by 1 / kFlatness, so that cross sections are narrow
// ellipses.
constexpr double kFlatness = 0.74;

// A ray this close has arrived. Much less than the step by which secondary rays leave a surface.
constexpr double kArrived = 4e-6;

// From `a` with radius `ra` to `b` with radius `rb`.
struct Capsule {
  Vec3 a;
  double ra;
  Vec3 b;
  double rb;
};

constexpr Capsule kNeck[] = {
    {{-0.02, 0.0, 0.26}, 0.225, {-0.085, 0.0, 0.56}, 0.185},
    {{-0.085, 0.0, 0.56}, 0.185, {-0.055, 0.0, 0.84}, 0.145},
    {{0.07, 0.0, 0.30}, 0.15, {0.02, 0.0, 0.56}, 0.11},
};
constexpr Capsule kHead[] = {
    {{-0.035, 0.0, 0.915}, 0.125, {0.275, 0.0, 0.715}, 0.068},
    {{0.04, 0.0, 0.80}, 0.10, {0.225, 0.0, 0.67}, 0.055},
};
constexpr Capsule kMane[] = {
    {{-0.25, 0.0, 0.44}, 0.035, {-0.225, 0.0, 0.72}, 0.04},
    {{-0.225, 0.0, 0.72}, 0.04, {-0.11, 0.0, 1.01}, 0.045},
};
constexpr Capsule kEar = {{-0.05, 0.08, 1.0}, 0.05, {-0.05, 0.095, 1.12}, 0.018};
constexpr Capsule kBrow = {{0.03, 0.115, 0.94}, 0.03, {0.11, 0.095, 0.885}, 0.022};
constexpr Capsule kEye = {{0.075, 0.135, 0.895}, 0.022, {0.078, 0.135, 0.893}, 0.022};
constexpr Capsule kNostril = {{0.29, 0.058, 0.735}, 0.024, {0.31, 0.058, 0.705}, 0.022};
constexpr Capsule kMouth = {{0.235, 0.09, 0.672}, 0.013, {0.33, 0.04, 0.645}, 0.013};

double distance(const Capsule& capsule, const Vec3& p) {
  const Vec3 along = capsule.b - capsule.a;
  const Vec3 from = p - capsule.a;
  const double s = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
  return length(from - s * along) - (capsule.ra + s * (capsule.rb - capsule.ra));
}

// The lesser of two distances with the crease between them filled over a width of about `k`.
double blend(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * k * h * h;
}

double distance_bound(const Vec3& p) {
  const Vec3 q{p.x, std::abs(p.y) / kFlatness, p.z};
  double neck = distance(kNeck[0], q);
  neck = blend(neck, distance(kNeck[1], q), 0.10);
  neck = blend(neck, distance(kNeck[2], q), 0.08);
  const double head = blend(distance(kHead[0], q), distance(kHead[1], q), 0.03);
  double d = blend(neck, head, 0.05);
  d = blend(d, std::min(distance(kMane[0], q), distance(kMane[1], q)), 0.02);
  d = blend(d, distance(kEar, q), 0.03);
  d = blend(d, distance(kBrow, q), 0.03);
  d = blend(d, distance(kEye, q), 0.008);
  d = blend(d, distance(kNostril, q), 0.015);
  d = -blend(-d, distance(kMouth, q), 0.015);
  // The stretch multiplies gradients by up to 1 / kFlatness, the taper by a little.
  return 0.92 * kFlatness * d;
}

}  // namespace

std::optional<Hit> intersect_horse_head(const Ray& ray, Interval range) {
  constexpr int kMaxSteps = 300;
  constexpr double kEpsilon = 2e-5;
  double t = range.t0;
  for (int step = 0; step < kMaxSteps && t < range.t1; ++step) {
    const Vec3 p = ray.at(t);
    const double d = distance_bound(p);
    if (d < kArrived) {
      const auto slope = [&](const Vec3& e) {
        return distance_bound(p + e) - distance_bound(p - e);
      };
      return Hit{
          t,
          {slope({kEpsilon, 0.0, 0.0}), slope({0.0, kEpsilon, 0.0}), slope({0.0, 0.0, kEpsilon})}};
    }
    t += d;
  }
  return std::nullopt;
}

}  // namespace scenes::chess
