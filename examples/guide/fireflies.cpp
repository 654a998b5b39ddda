// SPDX-License-Identifier: MIT
// One sample that is far too bright in a picture of 0.1 to 1: what it does to the rest.
#include <cmath>
#include <cstdio>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 256;

// A disc of stripes on a plain ground.
static double picture(double x, double y) {
  const bool stripe = std::sin(x * x / 700 + y / 50) > 0;
  return std::hypot(x - 128, y - 128) < 90 && stripe ? 1 : 0.1;
}

// Root mean square error without the blocks around the firefly.
static double error_of(const freqsynth::FrequencyImage& image) {
  const std::vector<float> pixels = freqsynth::reconstruct(image);
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    const double x = static_cast<double>(p % side), y = static_cast<double>(p / side);
    if (std::abs(x - 128) < 20 && std::abs(y - 128) < 20) continue;
    double mean = 0;
    for (int k = 0; k < 256; ++k) {
      mean += picture(x + (k % 16 + 0.5) / 16, y + (k / 16 + 0.5) / 16);
    }
    sum += std::pow(pixels[p] - mean / 256, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

int main() {
  std::printf("the one sample   error elsewhere, measure: residual   change\n");
  for (const double value : {1.0, 10.0, 1e3, 1e6}) {
    double errors[2] = {};
    for (const auto measure :
         {freqsynth::PriorityMeasure::residual, freqsynth::PriorityMeasure::change}) {
      freqsynth::SynthesisSettings settings{.width = side, .height = side, .channels = 1};
      settings.priority.measure = measure;
      freqsynth::Synthesizer engine(settings);
      const auto sampler = [&](double x, double y) {
        return x == 128 && y == 128 ? value : picture(x, y);
      };
      engine.run(sampler, {.samples_per_pixel = 0.5});
      errors[measure == freqsynth::PriorityMeasure::residual ? 0 : 1] =
          error_of(engine.finished_image());
    }
    std::printf("%-14g %36.4f %8.4f\n", value, errors[0], errors[1]);
  }
}
