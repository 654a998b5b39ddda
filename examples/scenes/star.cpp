// SPDX-License-Identifier: MIT
#include "star.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "area.h"

namespace scenes {
namespace {

constexpr double kSpokes = 37.0;
constexpr double kRadius = 0.47;  // of the lesser side

}  // namespace

// Not quite in the middle: the grid of pixels must not be a symmetry of the star.
Star::Star(int width, int height)
    : center_x_(0.507 * width),
      center_y_(0.494 * height),
      square_radius_(std::pow(kRadius * std::min(width, height), 2)) {}

void Star::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double dx = x - center_x_;
  const double dy = y - center_y_;
  float value = 1.0F;
  if (dx * dx + dy * dy < square_radius_) {
    const double turns = std::atan2(dy, dx) / (2.0 * std::numbers::pi);
    const double spoke = kSpokes * turns;
    value = spoke - std::floor(spoke) < 0.5 ? 0.0F : 1.0F;
  }
  std::fill(rgb.begin(), rgb.end(), value);
}

bool Star::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  const double left = static_cast<double>(i) - center_x_;
  const double top = static_cast<double>(j) - center_y_;
  const double radius = std::sqrt(square_radius_);
  double black = 0.0;
  for (double spoke = 0.0; spoke < kSpokes; spoke += 1.0) {
    black += sector_area(left, top, radius, spoke / kSpokes, (spoke + 0.5) / kSpokes);
  }
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(1.0 - black));
  return true;
}

}  // namespace scenes
