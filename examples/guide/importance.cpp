// SPDX-License-Identifier: MIT
// Errors that matter more in some places, and in some channels.
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 256;

// Stripes in the first channel, rings in the second.
static std::array<double, 2> radiance(double x, double y) {
  return {std::sin(x * x / 700 + y / 50) > 0 ? 1.0 : 0.0,
          std::sin((x * x + y * y) / 900) > 0 ? 1.0 : 0.0};
}

// Mean squared errors of both channels in the middle quarter of the picture and around it.
struct Errors {
  double middle[2] = {}, around[2] = {};
};

static Errors errors_of(const freqsynth::FrequencyImage& image) {
  const std::vector<float> pixels = freqsynth::reconstruct(image);
  Errors errors;
  for (std::size_t p = 0; p < side * side; ++p) {
    const std::size_t x = p % side, y = p / side;
    const bool inside = x >= 64 && x < 192 && y >= 64 && y < 192;
    for (std::size_t c = 0; c < 2; ++c) {
      double mean = 0;
      for (int k = 0; k < 256; ++k) {
        mean += radiance(static_cast<double>(x) + (k % 16 + 0.5) / 16,
                         static_cast<double>(y) + (k / 16 + 0.5) / 16)[c];
      }
      const double square = std::pow(pixels[2 * p + c] - mean / 256, 2);
      (inside ? errors.middle : errors.around)[c] += square / (inside ? 16384 : 49152);
    }
  }
  return errors;
}

static void show(const char* name, freqsynth::SynthesisSettings settings) {
  settings.width = side;
  settings.height = side;
  settings.channels = 2;
  freqsynth::Synthesizer engine(settings);
  engine.run(radiance, {.samples_per_pixel = 1});
  const Errors errors = errors_of(engine.finished_image());
  std::printf("%-22s %9.4f %9.4f %11.4f %9.4f\n", name, std::sqrt(errors.middle[0]),
              std::sqrt(errors.middle[1]), std::sqrt(errors.around[0]),
              std::sqrt(errors.around[1]));
}

int main() {
  // One factor per block of 8 x 8 pixels, row by row.
  std::vector<float> middle(32 * 32, 1);
  for (std::size_t block = 0; block < middle.size(); ++block) {
    const std::size_t x = block % 32, y = block / 32;
    if (x >= 8 && x < 24 && y >= 8 && y < 24) middle[block] = 10;
  }
  std::printf("                          middle: 1st, 2nd      around: 1st, 2nd\n");
  show("all alike", {});
  show("middle 10 times", {.importance = middle});
  show("1st channel 0.9, 0.1", {.channel_settings = {{.weight = 0.9f}, {.weight = 0.1f}}});
}
