// SPDX-License-Identifier: MIT
// The same number of samples fit by least squares, and kriged: a tree of nodes and a bank of
// priors.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 128;

// Shading, a disc, and twelve blades around it.
static double radiance(double x, double y) {
  const double u = x - 61.3, v = y - 66.8, r = std::hypot(u, v);
  const double shading = 0.3 + 0.002 * x - 0.001 * y;
  if (r < 24) return 1 - shading;
  const double turns = 12 * std::atan2(v, u) / (2 * std::numbers::pi);
  return r < 56 && turns - std::floor(turns) < 0.5 ? 0.9 : shading;
}

static double error_of(const std::vector<float>& pixels) {
  double sum = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    double mean = 0;
    for (int k = 0; k < 256; ++k) {
      mean += radiance(static_cast<double>(p % side) + (k % 16 + 0.5) / 16,
                       static_cast<double>(p / side) + (k / 16 + 0.5) / 16);
    }
    sum += std::pow(pixels[p] - mean / 256, 2);
  }
  return std::sqrt(sum / static_cast<double>(pixels.size()));
}

static double error_after(double samples_per_pixel, freqsynth::RefinerKind refiner) {
  freqsynth::SynthesisSettings settings;
  settings.width = settings.height = side;
  settings.channels = 1;
  settings.refiner = refiner;
  freqsynth::Synthesizer engine(settings);
  engine.run(radiance, {.samples_per_pixel = samples_per_pixel});
  return error_of(freqsynth::reconstruct(engine.finished_image()));
}

int main() {
  using freqsynth::RefinerKind;
  std::printf("samples per pixel   RMSE: least squares  kriging\n");
  for (const double samples : {0.0625, 0.25, 1.0, 4.0}) {
    std::printf("%17.4f %21.4f %8.4f\n", samples, error_after(samples, RefinerKind::least_squares),
                error_after(samples, RefinerKind::kriging));
  }
}
