// SPDX-License-Identifier: MIT
// A floor behind a wall and under a square lamp: for each sample a point of the lamp, at random or
// evenly spread.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "freqsynth/basis/owen_sobol.h"
#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 128;

// Whether the floor at (x, y) sees the point (u, v) of the lamp over the edge of the wall.
static double lit(double x, double y, double u, double v) {
  return x > 30 && u < 1.5 - 0.6 * (y + 20 * v) / (x - 30) ? 1 : 0;
}

// The mean over pixel (i, j) and the lamp: exact in u, a sum over points in the others.
static double truth(std::size_t i, std::size_t j) {
  double sum = 0;
  for (int k = 0; k < 512; ++k) {
    const double x = static_cast<double>(i) + (k % 8 + 0.5) / 8;
    const double y = static_cast<double>(j) + (k / 8 % 8 + 0.5) / 8;
    const double v = (k / 64 + 0.5) / 8;
    if (x > 30) sum += std::clamp(1.5 - 0.6 * (y + 20 * v) / (x - 30), 0.0, 1.0);
  }
  return sum / 512;
}

static double at_random(const freqsynth::Request& request) {
  const auto u = static_cast<double>(request.seed >> 32) * 0x1p-32;
  const auto v = static_cast<double>(request.seed & 0xffffffff) * 0x1p-32;
  return lit(request.x, request.y, u, v);
}

static double evenly(const freqsynth::Request& request) {
  constexpr std::uint64_t lamp = 1;  // a number for each decision; a frame's is mixed in
  const freqsynth::OwenSobol point(request.pixel, request.ordinal, lamp);
  return lit(request.x, request.y, point(0), point(1));
}

template <class Sampler>
static double error_of(const Sampler& sampler, double samples) {
  freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1});
  engine.run(sampler, {.samples_per_pixel = samples});
  const std::vector<float> pixels = freqsynth::reconstruct(engine.finished_image());
  double sum = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    sum += std::pow(pixels[p] - truth(p % side, p / side), 2);
  }
  return std::sqrt(sum / static_cast<double>(pixels.size()));
}

int main() {
  std::printf("samples   at random    evenly\n");
  for (const double samples : {1.0, 4.0, 16.0}) {
    std::printf("%7.0f %11.4f %9.4f\n", samples, error_of(at_random, samples),
                error_of(evenly, samples));
  }
}
