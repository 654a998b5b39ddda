// SPDX-License-Identifier: MIT
#include "alpha_trimmed.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace baselines {
namespace {

constexpr std::size_t kValues = 7;

/// Component `c` at a distance of (dx, dy) from the centre of a pixel.
double interpolate(const Rendering& rendering, double x, double y, std::size_t c) {
  x = std::clamp(x, 0.0, static_cast<double>(rendering.width - 1));
  y = std::clamp(y, 0.0, static_cast<double>(rendering.height - 1));
  const auto left = static_cast<std::size_t>(x);
  const auto top = static_cast<std::size_t>(y);
  const std::size_t right = std::min(left + 1, rendering.width - 1);
  const std::size_t bottom = std::min(top + 1, rendering.height - 1);
  const double s = x - static_cast<double>(left);
  const double t = y - static_cast<double>(top);
  const auto value = [&](std::size_t column, std::size_t row) {
    return static_cast<double>(rendering.pixels[(row * rendering.width + column) * 3 + c]);
  };
  return std::lerp(std::lerp(value(left, top), value(right, top), s),
                   std::lerp(value(left, bottom), value(right, bottom), s), t);
}

}  // namespace

Rendering alpha_trimmed(const Rendering& rendering, const AlphaTrimmedSettings& settings) {
  if (!(settings.alpha >= 0 && settings.alpha < 0.5)) {
    throw std::invalid_argument("alpha must lie in [0, 0.5), but is " +
                                std::to_string(settings.alpha));
  }
  double dx[kValues] = {};
  double dy[kValues] = {};
  for (std::size_t i = 1; i < kValues; ++i) {
    const double angle = static_cast<double>(i) * std::numbers::pi / 3;
    dx[i] = settings.distance * std::cos(angle);
    dy[i] = settings.distance * std::sin(angle);
  }
  const auto trimmed = static_cast<std::ptrdiff_t>(settings.alpha * double{kValues});
  Rendering filtered = rendering;
  for (std::size_t y = 0; y < rendering.height; ++y) {
    for (std::size_t x = 0; x < rendering.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        double values[kValues];
        for (std::size_t i = 0; i < kValues; ++i) {
          values[i] = interpolate(rendering, static_cast<double>(x) + dx[i],
                                  static_cast<double>(y) + dy[i], c);
        }
        std::sort(std::begin(values), std::end(values));
        double sum = 0;
        for (auto i = std::begin(values) + trimmed; i != std::end(values) - trimmed; ++i) sum += *i;
        filtered.pixels[(y * rendering.width + x) * 3 + c] =
            static_cast<float>(sum / static_cast<double>(std::ptrdiff_t{kValues} - 2 * trimmed));
      }
    }
  }
  return filtered;
}

}  // namespace baselines
