// SPDX-License-Identifier: MIT
#include "edge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "area.h"

namespace scenes {
namespace {

// The unit normal of the edge, towards white.
const double kAngle = 5.0 * std::numbers::pi / 180.0;
const double kX = std::cos(kAngle);
const double kY = std::sin(kAngle);

}  // namespace

Edge::Edge(int width, int height) : offset_(0.43 * width * kX + 0.5 * height * kY) {}

void Edge::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  std::fill(rgb.begin(), rgb.end(), kX * x + kY * y < offset_ ? 0.0F : 1.0F);
}

bool Edge::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  const double x = static_cast<double>(i);
  const double y = static_cast<double>(j);
  const double black = half_plane_area(kX, kY, offset_ - kX * x - kY * y);
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(1.0 - black));
  return true;
}

}  // namespace scenes
