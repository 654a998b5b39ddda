// SPDX-License-Identifier: MIT
// A single stray value, like the fireflies of path tracers, stays where it is: the error elsewhere
// hardly changes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

constexpr std::size_t size = 256;

/// Values of .1 to 1: a disc, stripes, a smooth part and a flat one.
double scene(double x, double y) {
  if (std::hypot(x - 80, y - 100) < 44) return 0.9;
  if (y > 160) return std::sin(0.5 * x + 0.03 * y * y) > 0 ? 0.8 : 0.3;
  return x > 180 ? 0.2 : 0.1 + 0.002 * x;
}

/// Means of each pixel, by 16 x 16 points.
const std::vector<double>& truth() {
  static const std::vector<double> means = [] {
    std::vector<double> all;
    for (std::size_t y = 0; y < size; ++y) {
      for (std::size_t x = 0; x < size; ++x) {
        double sum = 0;
        for (int i = 0; i < 256; ++i) {
          sum += scene(static_cast<double>(x) + (i % 16 + 0.5) / 16,
                       static_cast<double>(y) + (i / 16 + 0.5) / 16);
        }
        all.push_back(sum / 256);
      }
    }
    return all;
  }();
  return means;
}

struct Result {
  double error = 0;  // root mean square, without the blocks around the stray value
  std::uint64_t most = 0;
};

/// \param stray   number of the sample whose value is stray; none beyond the last one
/// \param x, y    receive its place; the pixels around it are left out of the error
Result result_of(PriorityMeasure measure, double spp, std::size_t stray, float value, double& x,
                 double& y) {
  SynthesisSettings settings = helpers::settings_of(size, size);
  settings.priority.measure = measure;
  // The paper's measure on the paper's lattice. On the bent one it is up to 6 percent.
  if (measure == PriorityMeasure::change) settings.list.positions = SamplePositions::lattice;
  Synthesizer engine(settings);
  std::size_t asked = 0;
  engine.run(
      [&](const Request& request) {
        if (request.again || asked++ != stray) {
          return static_cast<float>(scene(request.x, request.y));
        }
        x = request.x;
        y = request.y;
        return value;
      },
      {.samples_per_pixel = spp});
  const std::vector<float> pixels = reconstruct(engine.finished_image());
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double dx = static_cast<double>(i % size) + 0.5 - x;
    const double dy = static_cast<double>(i / size) + 0.5 - y;
    // All blocks that the value may belong to lie within.
    if (std::abs(dx) <= 8 && std::abs(dy) <= 8) continue;
    sum += std::pow(static_cast<double>(pixels[i]) - truth()[i], 2);
    ++count;
  }
  Result result{std::sqrt(sum / count), 0};
  for (const std::uint32_t samples : helpers::counts_of(engine.image())) {
    result.most = std::max<std::uint64_t>(result.most, samples);
  }
  return result;
}

class Firefly : public testing::TestWithParam<std::tuple<PriorityMeasure, float>> {};
INSTANTIATE_TEST_SUITE_P(
    MeasuresAndValues, Firefly,
    testing::Combine(testing::Values(PriorityMeasure::residual, PriorityMeasure::change),
                     testing::Values(10.0f, 1e3f, 1e6f, -1e9f, 1e15f, 1e25f, -1e36f)));

TEST_P(Firefly, StaysWhereItIs) {
  const auto [measure, value] = GetParam();
  constexpr std::size_t never = ~std::size_t{0};
  for (const double spp : {0.5, 1.0, 4.0}) {
    const auto budget = static_cast<std::size_t>(spp * size * size);
    // Among the corners (0 .. 1088), right after them, and later.
    for (const std::size_t stray :
         {std::size_t{7}, std::size_t{550}, std::size_t{1500}, budget / 5, budget / 2}) {
      double x = 0, y = 0;
      const Result with = result_of(measure, spp, stray, value, x, y);
      const Result without = result_of(measure, spp, never, value, x, y);
      EXPECT_LT(with.error, 1.03 * without.error)
          << spp << " samples per pixel, stray sample " << stray << " at " << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace freqsynth
