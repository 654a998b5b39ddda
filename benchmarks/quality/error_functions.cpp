// SPDX-License-Identifier: MIT
#include "error_functions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <random>
#include <vector>

#include "field_cases/members.h"
#include "freqsynth/freqsynth.h"

namespace quality {
namespace {

/// Estimates of v: v / p with the probability p, else 0.
constexpr double seen = 0.25;

double ratio_of(const field_cases::Field& field, double rate, bool noisy, std::uint64_t seed) {
  freqsynth::SynthesisSettings settings{
      .width = field.width, .height = field.height, .channels = 1, .seed = seed};
  settings.list.seed = seed;
  freqsynth::Synthesizer engine(settings);
  engine.run(
      [&](const freqsynth::Request& request) {
        const double value = field.value(request.x, request.y);
        if (!noisy) return static_cast<float>(value);
        std::mt19937_64 random(request.seed);
        const bool hit = static_cast<double>(random() >> 11) * 0x1p-53 < seen;
        return hit ? static_cast<float>(value / seen) : 0.0f;
      },
      {.samples_per_pixel = rate});
  const std::vector<float> pixels = freqsynth::reconstruct(engine.finished_image());
  double square = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double right =
        field.average(static_cast<double>(i % field.width), static_cast<double>(i / field.width));
    square += std::pow(double{pixels[i]} - right, 2) / static_cast<double>(pixels.size());
  }
  return engine.predicted_rmse() / std::sqrt(square);
}

}  // namespace

std::string random_functions_table(std::size_t functions, freqsynth::ThreadPool& pool) {
  constexpr std::uint64_t family = 7;
  constexpr double rates[] = {0.25, 1, 4, 16};
  std::string table =
      "| functions | samples | least | a tenth is below | median | a tenth is above | greatest | "
      "within .67 .. 1.5 |\n|---|---|---|---|---|---|---|---|\n";
  for (const bool noisy : {false, true}) {
    for (const double rate : rates) {
      std::vector<double> ratios(functions);
      const auto one = [&](std::size_t i) {
        ratios[i] = ratio_of(field_cases::random_function(family, i), rate, noisy, i + 1);
      };
      pool.execute(functions, freqsynth::TaskRef(one));
      std::sort(ratios.begin(), ratios.end());
      const auto within = std::count_if(ratios.begin(), ratios.end(),
                                        [](double ratio) { return ratio > 0.67 && ratio < 1.5; });
      char line[160];
      std::snprintf(line, sizeof line, "| %s | %s | %.2f | %.2f | %.2f | %.2f | %.2f | %ld %% |\n",
                    noisy ? "with noise" : "without",
                    rate < 1 ? "1/4" : std::to_string(static_cast<int>(rate)).c_str(),
                    ratios.front(), ratios[functions / 10], ratios[functions / 2],
                    ratios[functions - 1 - functions / 10], ratios.back(),
                    static_cast<long>(100 * within) / static_cast<long>(functions));
      table += line;
    }
  }
  return table;
}

}  // namespace quality
