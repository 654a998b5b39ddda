#include "zone_plate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scenes {

ZonePlate::ZonePlate(int width, int height, double frequency)
    : phase_scale_(std::numbers::pi * frequency /
                   std::hypot(static_cast<double>(width), static_cast<double>(height))) {
  if (!std::isfinite(frequency) || frequency < 0.0) {
    throw std::invalid_argument("zone frequency must be finite and >= 0, but is " +
                                std::to_string(frequency));
  }
}

void ZonePlate::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double value = 0.5 + 0.5 * std::cos(phase_scale_ * (x * x + y * y));
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(value));
}

}  // namespace scenes
