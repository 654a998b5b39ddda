// SPDX-License-Identifier: MIT
#include "fan.h"

#include <algorithm>

#include "area.h"

namespace scenes {
namespace {

// An odd number of stripes, so that both the outermost ones are black: 15.5 pairs.
constexpr double kStripes = 31.0;
constexpr double kTop = 0.06;
constexpr double kBottom = 0.94;
constexpr double kTopWidth = 0.86;
constexpr double kBottomWidth = 0.06;

constexpr double fan_width(double v) {
  return kTopWidth + (kBottomWidth - kTopWidth) * (v - kTop) / (kBottom - kTop);
}

}  // namespace

Fan::Fan(int width, int height) : unit_per_pixel_x_(1.0 / width), unit_per_pixel_y_(1.0 / height) {}

void Fan::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double u = x * unit_per_pixel_x_;
  const double v = y * unit_per_pixel_y_;
  float value = 1.0F;
  if (v >= kTop && v < kBottom) {
    const double stripe = kStripes * ((u - 0.5) / fan_width(v) + 0.5);
    if (stripe >= 0.0 && stripe < kStripes) {
      value = static_cast<int>(stripe) % 2 == 0 ? 0.0F : 1.0F;
    }
  }
  std::fill(rgb.begin(), rgb.end(), value);
}

bool Fan::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  // The part of the pixel's rows that has stripes; each border between two stripes is a line there.
  const double first = static_cast<double>(j) * unit_per_pixel_y_;
  const double top = std::max(first, kTop);
  const double bottom = std::min(first + unit_per_pixel_y_, kBottom);
  double black = 0.0;
  if (top < bottom) {
    const auto left_of = [&](double border) {
      const auto from_left = [&](double v) {
        const double u = 0.5 + fan_width(v) * (border / kStripes - 0.5);
        return u / unit_per_pixel_x_ - static_cast<double>(i);
      };
      return left_area(from_left(top), from_left(bottom));
    };
    for (double stripe = 0.0; stripe < kStripes; stripe += 2.0) {
      black += left_of(stripe + 1.0) - left_of(stripe);
    }
    black *= (bottom - top) / unit_per_pixel_y_;
  }
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(1.0 - black));
  return true;
}

}  // namespace scenes
