// SPDX-License-Identifier: MIT
#include "gradient.h"

#include <array>
#include <cmath>
#include <numbers>

#include "vec3.h"

namespace scenes {
namespace {

struct Wave {
  double across, down;  // cycles per image
  double turns;         // phase at the top left corner
  Vec3 color;           // amplitude
};

// The amplitudes of a colour add up to less than its mean: no value is negative.
constexpr Vec3 kMean{0.45, 0.40, 0.42};
constexpr std::array<Wave, 3> kWaves = {{
    {0.6, 0.2, 0.55, {0.28, 0.05, -0.10}},
    {-0.3, 0.7, 0.25, {-0.06, 0.24, 0.08}},
    {0.9, 0.8, 0.80, {0.08, -0.06, 0.20}},
}};

double sinc(double cycles) {
  const double s = std::numbers::pi * cycles;
  return s == 0.0 ? 1.0 : std::sin(s) / s;
}

// The mean over a rectangle of the given size about (u, v), all in images.
Vec3 mean_color(double u, double v, double width, double height) {
  Vec3 color = kMean;
  for (const Wave& wave : kWaves) {
    const double turns = wave.across * u + wave.down * v + wave.turns;
    const double left = sinc(wave.across * width) * sinc(wave.down * height);
    color = color + left * std::cos(2.0 * std::numbers::pi * turns) * wave.color;
  }
  return color;
}

}  // namespace

Gradient::Gradient(int width, int height)
    : unit_per_pixel_x_(1.0 / width), unit_per_pixel_y_(1.0 / height) {}

void Gradient::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  store(mean_color(x * unit_per_pixel_x_, y * unit_per_pixel_y_, 0.0, 0.0), rgb);
}

bool Gradient::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  const double u = (static_cast<double>(i) + 0.5) * unit_per_pixel_x_;
  const double v = (static_cast<double>(j) + 0.5) * unit_per_pixel_y_;
  store(mean_color(u, v, unit_per_pixel_x_, unit_per_pixel_y_), rgb);
  return true;
}

}  // namespace scenes
