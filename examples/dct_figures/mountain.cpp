// SPDX-License-Identifier: MIT
#include "mountain.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using Color = std::array<double, 3>;

/// A number in [-1, 1) for each point of the lattice (the finaliser of SplitMix64).
double lattice(std::uint64_t seed, std::int64_t i, std::int64_t k) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15 + static_cast<std::uint64_t>(i) * 0xd1b54a32d192ed03 +
                    static_cast<std::uint64_t>(k) * 0x8cb92ba72f3d8dd7;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Noise of about one half cycle per unit, with continuous curvature: no creases in the shading.
double noise(std::uint64_t seed, double x, double z) {
  const double left = std::floor(x);
  const double front = std::floor(z);
  const auto ease = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const double s = ease(x - left);
  const double t = ease(z - front);
  const auto i = static_cast<std::int64_t>(left);
  const auto k = static_cast<std::int64_t>(front);
  return std::lerp(std::lerp(lattice(seed, i, k), lattice(seed, i + 1, k), s),
                   std::lerp(lattice(seed, i, k + 1), lattice(seed, i + 1, k + 1), s), t);
}

/// Height of the ground: a broad mountain and the fractal.
double ground(const Fractal& fractal, double x, double z) {
  const double dx = x / 1.5;
  const double dz = (z - 3) / 1.2;
  double height = 1.5 * std::exp(-dx * dx - dz * dz);
  double amplitude = 0.25;
  double frequency = 1.5;
  for (int octave = 0; octave < fractal.octaves; ++octave) {
    const std::uint64_t seed = fractal.seed * 64 + static_cast<std::uint64_t>(octave);
    height += amplitude * noise(seed, x * frequency, z * frequency);
    amplitude *= fractal.gain;
    frequency *= 2;
  }
  return height;
}

/// The ground in the light of a low sun on the left.
Color shade(const Fractal& fractal, double x, double z, double height) {
  constexpr double step = 1e-3;
  const double slope_x = (ground(fractal, x + step, z) - height) / step;
  const double slope_z = (ground(fractal, x, z + step) - height) / step;
  const double facing = (0.7 * slope_x + 0.5 * slope_z + 0.5) / std::hypot(slope_x, slope_z, 1.0);
  const double light = 45 + 200 * std::max(facing, 0.0);
  return {light, 0.86 * light, 0.68 * light};
}

}  // namespace

Picture mountainside(const Fractal& fractal, std::size_t width, std::size_t height) {
  constexpr std::size_t finer = 2;  // rows and columns per pixel
  constexpr double camera = 1.0, near = 0.8, far = 5, horizon = 0.38;
  constexpr Color sky{119, 153, 187};
  constexpr int steps = 800;
  const std::size_t columns = finer * width;
  const std::size_t rows = finer * height;
  const auto focal = static_cast<double>(rows);
  std::vector<Color> fine(columns * rows, sky);
  for (std::size_t column = 0; column < columns; ++column) {
    const double direction =
        (static_cast<double>(column) + 0.5 - 0.5 * static_cast<double>(columns)) / focal;
    // From front to back: what is seen rises above all that is nearer.
    std::size_t seen = rows;
    for (int step = 0; step < steps && seen > 0; ++step) {
      const double z = near * std::pow(far / near, static_cast<double>(step) / steps);
      const double y = ground(fractal, direction * z, z);
      const double row = focal * (horizon + (camera - y) / z);
      if (!(row < static_cast<double>(seen) - 0.5)) continue;
      const Color color = shade(fractal, direction * z, z, y);
      while (seen > 0 && row < static_cast<double>(seen) - 0.5) {
        fine[--seen * columns + column] = color;
      }
    }
  }
  Picture picture{width, height, 3, std::vector<float>(width * height * 3)};
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const std::size_t pixel = i / columns / finer * width + i % columns / finer;
    for (std::size_t c = 0; c < 3; ++c) {
      picture.pixels[3 * pixel + c] += static_cast<float>(fine[i][c] / (finer * finer));
    }
  }
  return picture;
}
