// SPDX-License-Identifier: MIT
#include "zone_plate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace scenes {
namespace {

struct Node {
  double at, weight;
};

// Of the Gauss-Legendre rule with 8 points on [-1, 1], which is symmetric: the positive half.
constexpr std::array<Node, 4> kGauss = {{{0.1834346424956498, 0.3626837833783620},
                                         {0.5255324099163290, 0.3137066458778873},
                                         {0.7966664774136267, 0.2223810344533745},
                                         {0.9602898564975363, 0.1012285362903763}}};

// More phase than this many half turns along a pixel's side is left to samples.
constexpr double kMostHalfTurns = 256.0;

double half_turns(double phase_scale, double from) {
  return phase_scale * (2.0 * from + 1.0) / std::numbers::pi;
}

// The mean of exp(i phase_scale x^2) over [from, from + 1]. With at most half a turn of the phase
// in a panel the rule's error is at most 1.4e-9, in a picture of a single pixel; below 1e-12 where
// a turn takes eight pixels or more.
std::complex<double> mean_wave(double phase_scale, double from) {
  const double panels = std::max(std::ceil(half_turns(phase_scale, from)), 1.0);
  const double half = 0.5 / panels;
  std::complex<double> sum = 0.0;
  for (double panel = 0.0; panel < panels; panel += 1.0) {
    const double middle = from + (2.0 * panel + 1.0) * half;
    for (const auto& [at, weight] : kGauss) {
      for (const double x : {middle - half * at, middle + half * at}) {
        sum += weight * std::polar(1.0, phase_scale * x * x);
      }
    }
  }
  return 0.5 / panels * sum;
}

}  // namespace

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

bool ZonePlate::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  const double x = static_cast<double>(i);
  const double y = static_cast<double>(j);
  if (!(half_turns(phase_scale_, std::max(x, y)) <= kMostHalfTurns)) return false;
  // The wave is a product of one along x and one along y, and so is its mean.
  const std::complex<double> mean = mean_wave(phase_scale_, x) * mean_wave(phase_scale_, y);
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(0.5 + 0.5 * mean.real()));
  return true;
}

}  // namespace scenes
