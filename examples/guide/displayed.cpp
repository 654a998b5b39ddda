// SPDX-License-Identifier: MIT
// A picture with lamplight and dusk, in linear light, that is shown in sRGB.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 256;

// A wall of tiles with light that falls from 1 in the upper right to 1/300 in the lower left.
static double radiance(double x, double y) {
  const double light = std::exp(-std::hypot(side - x, y) / 60);
  const bool joint = std::sin(0.5 * x + 2 * std::sin(0.04 * y)) + std::sin(0.45 * y) > 1;
  return light * (joint ? 0.3 : 1);
}

static double shown(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// The true pixels: means of 256 points each.
static std::vector<double> true_pixels() {
  std::vector<double> pixels(side * side);
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    for (int k = 0; k < 256; ++k) {
      pixels[p] += radiance(static_cast<double>(p % side) + (k % 16 + 0.5) / 16,
                            static_cast<double>(p / side) + (k / 16 + 0.5) / 16) /
                   256;
    }
  }
  return pixels;
}

int main() {
  const std::vector<double> truth = true_pixels();
  std::printf("                              error in linear light        error as shown\n");
  std::printf("samples   steer           bright    dark     all    bright    dark     all\n");
  const char* const names[] = {"linear", "relative", "display"};
  for (const double rate : {1.0, 4.0}) {
    for (const auto steer :
         {freqsynth::Steer::linear, freqsynth::Steer::relative, freqsynth::Steer::display}) {
      freqsynth::Synthesizer engine(
          {.width = side, .height = side, .channels = 1, .priority = {.steer = steer}});
      engine.run(radiance, {.samples_per_pixel = rate});
      const std::vector<float> pixels = freqsynth::reconstruct(engine.finished_image());
      // Squared errors in linear light and as shown, of the brighter and of the darker pixels.
      double squares[2][2] = {}, counts[2] = {};
      for (std::size_t p = 0; p < pixels.size(); ++p) {
        const bool dark =
            std::hypot(side - static_cast<double>(p % side), static_cast<double>(p / side)) > 150;
        squares[0][dark] += std::pow(pixels[p] - truth[p], 2);
        squares[1][dark] += std::pow(shown(pixels[p]) - shown(truth[p]), 2);
        ++counts[dark];
      }
      std::printf("%7.2f   %-8s    ", rate, names[static_cast<int>(steer)]);
      for (const auto& [bright, dark] : squares) {
        std::printf("   %7.4f %7.4f %7.4f", std::sqrt(bright / counts[0]),
                    std::sqrt(dark / counts[1]),
                    std::sqrt((bright + dark) / (counts[0] + counts[1])));
      }
      std::printf("\n");
    }
  }
}
