// SPDX-License-Identifier: MIT
// What a number of samples buys, what an aliasing threshold and what a target; an end after a time.
#include <cmath>
#include <cstdio>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 256;

// A soft picture, and one with edges that come ever closer.
static double soft(double x, double y) { return 0.5 + 0.4 * std::sin(x / 40) * std::cos(y / 30); }
static double stripes(double x, double y) { return std::sin(x * x / 700 + y / 50) > 0 ? 0.9 : 0.1; }

// Root mean square error against the means of 16 x 16 points in each pixel.
static double error_of(const freqsynth::FrequencyImage& image, double (*picture)(double, double)) {
  const std::vector<float> pixels = freqsynth::reconstruct(image);
  double sum = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    double mean = 0;
    for (int k = 0; k < 256; ++k) {
      mean += picture(static_cast<double>(p % side) + (k % 16 + 0.5) / 16,
                      static_cast<double>(p / side) + (k / 16 + 0.5) / 16);
    }
    sum += std::pow(pixels[p] - mean / 256, 2);
  }
  return std::sqrt(sum / static_cast<double>(pixels.size()));
}

static void show(const char* name, double (*picture)(double, double),
                 const freqsynth::StopRule& stop) {
  freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1});
  engine.run(picture, stop);
  const double samples = static_cast<double>(engine.stats().samples);
  const double threshold = stop.aliasing_threshold;
  std::printf("%-8s %10.2f %10.3f %20.3f %10.5f\n", name, stop.samples_per_pixel, threshold,
              samples / (side * side), error_of(engine.finished_image(), picture));
}

static void aim(const char* name, double (*picture)(double, double), double target) {
  freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1});
  engine.run(picture, {.samples_per_pixel = 64, .target_rmse = target});
  std::printf("%-8s %10.4f %20.3f %10.5f\n", name, target,
              static_cast<double>(engine.stats().samples) / (side * side),
              error_of(engine.finished_image(), picture));
}

int main() {
  std::printf("picture    at most  threshold    samples per pixel      error\n");
  for (const double most : {0.25, 1.0, 4.0}) {
    show("soft", soft, {.samples_per_pixel = most});
    show("stripes", stripes, {.samples_per_pixel = most});
  }
  for (const double threshold : {0.01, 0.003, 0.001}) {
    show("soft", soft, {.samples_per_pixel = 16, .aliasing_threshold = threshold});
    show("stripes", stripes, {.samples_per_pixel = 16, .aliasing_threshold = threshold});
  }
  std::printf("\npicture      target    samples per pixel      error\n");
  for (const double target : {0.03, 0.01}) {
    aim("soft", soft, target);
    aim("stripes", stripes, target);
  }
  std::printf("\n");
  // The first rule that holds ends it.
  freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1});
  const auto report = engine.run(stripes, {.samples_per_pixel = 800, .seconds = 0.05});
  std::printf("ended by %s\n",
              report.reason == freqsynth::StopReason::seconds ? "the time" : "another rule");
}
