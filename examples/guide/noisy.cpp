// SPDX-License-Identifier: MIT
// A sampler with noise, a Monte Carlo estimate with the request's seed, and one without.
#include <cmath>
#include <cstdio>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 128;

// The mean of the estimates: a disc with a soft shadow.
static double truth(double x, double y) {
  const double distance = std::hypot(x - 64, y - 64);
  return distance < 40 ? 1.0 : 0.5 - 0.5 * std::exp((40 - distance) / 20);
}

// Returns the truth times a random number around 1: a sampler that sees the whole request.
struct Estimate {
  double spread;  // 0: no noise; 1: factors from 0 to 2

  double operator()(const freqsynth::Request& request) const {
    const double chance = static_cast<double>(request.seed >> 11) * 0x1p-53;  // in [0, 1)
    return truth(request.x, request.y) * (1 + spread * (2 * chance - 1));
  }
};

static double error_of(const freqsynth::FrequencyImage& image) {
  const std::vector<float> pixels = freqsynth::reconstruct(image);
  double sum = 0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    double mean = 0;
    for (int k = 0; k < 64; ++k) {
      mean += truth(static_cast<double>(p % side) + (k % 8 + 0.5) / 8,
                    static_cast<double>(p / side) + (k / 8 + 0.5) / 8);
    }
    sum += std::pow(pixels[p] - mean / 64, 2);
  }
  return std::sqrt(sum / static_cast<double>(pixels.size()));
}

static void measure(double spread, double samples_per_pixel) {
  for (const auto noise :
       {freqsynth::Noise::none, freqsynth::Noise::present, freqsynth::Noise::automatic}) {
    freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1, .noise = noise});
    engine.run(Estimate{spread}, {.samples_per_pixel = samples_per_pixel});
    std::printf("%9.4f", error_of(engine.finished_image()));
    if (noise != freqsynth::Noise::automatic) continue;
    const freqsynth::SynthesisStats stats = engine.stats();
    std::printf(" %6zu", static_cast<std::size_t>(stats.probes));
  }
}

int main() {
  std::printf("              sampler with noise                 without noise\n");
  std::printf("samples     none  present automatic twice    none  present automatic twice\n");
  for (const double samples : {0.25, 1.0, 4.0, 16.0}) {
    std::printf("%6.2f ", samples);
    measure(1, samples);
    measure(0, samples);
    std::printf("\n");
  }
}
