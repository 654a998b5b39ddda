// SPDX-License-Identifier: MIT
#include "lit_corner.h"

#include <algorithm>

#include "area.h"
#include "vec3.h"

namespace scenes {
namespace {

constexpr double kRadius = 0.12;  // of the lesser side
constexpr Vec3 kLight{1.0, 0.75, 0.4};

}  // namespace

LitCorner::LitCorner(int width, int height)
    : width_(width), height_(height), radius_(kRadius * std::min(width, height)) {}

void LitCorner::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double dx = x - width_;
  const double dy = y - height_;
  store(dx * dx + dy * dy < radius_ * radius_ ? kLight : Vec3{}, rgb);
}

bool LitCorner::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  const double left = static_cast<double>(i) - width_;
  const double top = static_cast<double>(j) - height_;
  store(disc_area(left, top, radius_) * kLight, rgb);
  return true;
}

}  // namespace scenes
