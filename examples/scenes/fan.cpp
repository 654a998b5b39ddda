#include "fan.h"

#include <algorithm>

namespace scenes {
namespace {

// An odd number of stripes, so that both the outermost ones are black: 15.5 pairs.
constexpr double kStripes = 31.0;
constexpr double kTop = 0.06;
constexpr double kBottom = 0.94;
constexpr double kTopWidth = 0.86;
constexpr double kBottomWidth = 0.06;

}  // namespace

Fan::Fan(int width, int height) : unit_per_pixel_x_(1.0 / width), unit_per_pixel_y_(1.0 / height) {}

void Fan::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double u = x * unit_per_pixel_x_;
  const double v = y * unit_per_pixel_y_;
  float value = 1.0F;
  if (v >= kTop && v < kBottom) {
    const double fan_width = kTopWidth + (kBottomWidth - kTopWidth) * (v - kTop) / (kBottom - kTop);
    const double stripe = kStripes * ((u - 0.5) / fan_width + 0.5);
    if (stripe >= 0.0 && stripe < kStripes) {
      value = static_cast<int>(stripe) % 2 == 0 ? 0.0F : 1.0F;
    }
  }
  std::fill(rgb.begin(), rgb.end(), value);
}

}  // namespace scenes
