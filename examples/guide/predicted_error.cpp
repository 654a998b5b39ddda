// SPDX-License-Identifier: MIT
// Samples until the picture is expected to be right within a given error.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 256;

static double radiance(double x, double y) {
  const bool tile = std::fmod(x + 0.3 * y, 41) < 20;
  return (tile ? 0.8 : 0.2) * std::exp(-std::hypot(x - 90, y - 60) / 150);
}

// The true root mean square error, with the pixels' means of 256 points each.
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

int main() {
  freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1});
  std::printf("   wanted  samples  predicted      true\n");
  double samples = 0.25;
  for (const double wanted : {0.03, 0.01, 0.003, 0.001}) {
    double predicted = std::numeric_limits<double>::infinity();
    while (predicted > wanted) {
      engine.run(radiance, {.samples_per_pixel = samples});
      predicted = engine.predicted_rmse();
      if (predicted > wanted) samples *= 1.2;
    }
    const double error = error_of(freqsynth::reconstruct(engine.finished_image()));
    std::printf("%9.4f %8.2f %10.4f %9.4f\n", wanted, samples, predicted, error);
  }

  // Where the errors are: one pixel in a hundred has so much of the squares.
  std::vector<float> errors = engine.error_image();
  std::sort(errors.rbegin(), errors.rend());
  double all = 0, worst = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double square = double{errors[i]} * double{errors[i]};
    all += square;
    if (i < errors.size() / 100) worst += square;
  }
  std::printf("1 %% of the pixels have %.0f %% of the expected squares\n", 100 * worst / all);
}
