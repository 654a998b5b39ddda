// SPDX-License-Identifier: MIT
// Samples without a usable value are no information, and no agreement.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using helpers::settings_of;

constexpr std::size_t size = 128;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Whether the value at a point is bad: at random, for one in `k`.
bool is_bad(double x, double y, std::uint64_t k, std::uint64_t seed) {
  const std::uint64_t name = mix(std::bit_cast<std::uint64_t>(x) * 3 + mix(seed + 1));
  return k > 0 && mix(name + std::bit_cast<std::uint64_t>(y) * 5) % k == 0;
}

double stripes(double x, double y) { return std::sin(0.3 * x + 0.01 * y * y) > 0 ? 1 : 0.2; }
double disc(double x, double y) { return std::hypot(x - 60, y - 70) < 40 ? 0.9 : 0.1 + 0.003 * x; }
double waves(double x, double y) { return 0.5 + 0.4 * std::sin(0.2 * x) * std::cos(0.13 * y); }

struct Result {
  double rmse = 0;
  double good_per_pixel = 0;
};

template <class Function>
Result result_of(const Function& f, double spp, std::uint64_t k, std::uint64_t seed) {
  Synthesizer engine(settings_of(size, size));
  engine.run([&](double x, double y) { return is_bad(x, y, k, seed) ? nan : f(x, y); },
             {.samples_per_pixel = spp});
  const std::vector<float> pixels = reconstruct(engine.finished_image());
  const double rmse = helpers::rmse_of(pixels, size, f);
  const SynthesisStats stats = engine.stats();
  const double pixels_all = size * size;
  return {rmse, static_cast<double>(stats.samples - stats.bad_samples) / pixels_all};
}

TEST(Gaps, CostAboutWhatMissingSamplesDo) {
  // What is left of an even lattice when half of it falls away at random is not even, which costs
  // something of its own, the more the better the lattice was. Measured: for half of them 1.22 at
  // two samples per pixel, 1.33 at four, where what is left is compared with whole lattices.
  struct Share {
    std::uint64_t k;
    double rate, most;
  };
  for (const auto& [k, rate, most] : {Share{2, 2, 1.3}, Share{4, 4, 1.1}, Share{20, 4, 1.1}}) {
    for (const std::uint64_t seed : {1u, 2u}) {
      const Result with = result_of(stripes, rate, k, seed);
      const Result without = result_of(stripes, with.good_per_pixel, 0, 0);
      EXPECT_LT(with.rmse, most * without.rmse) << "1 in " << k;
    }
  }
}

TEST(Gaps, RandomOnesAreNoDisaster) {
  oracle::Random random(5);
  for (const auto f : {stripes, disc, waves}) {
    for (int i = 0; i < 2; ++i) {
      const auto k = 2 + random.below(6);
      const Result with = result_of(f, 2, k, random.below(1000));
      const Result without = result_of(f, with.good_per_pixel, 0, 0);
      EXPECT_LT(with.rmse, 1.4 * without.rmse + 1e-3) << "1 in " << k;
    }
  }
}

TEST(Gaps, LeaveNoHolesInThePicture) {
  for (const double spp : {1.0, 4.0}) {
    for (const std::uint64_t k : {2u, 3u, 5u}) {
      Synthesizer engine(settings_of(size, size));
      engine.run([&](double x, double y) { return is_bad(x, y, k, 3) ? nan : stripes(x, y); },
                 {.samples_per_pixel = spp});
      for (const float pixel : reconstruct(engine.finished_image())) {
        // Pixels stay within what samples have shown, .2 to 1, and a slack of .4 of it.
        ASSERT_TRUE(pixel > -0.13 && pixel < 1.33) << pixel << ", 1 in " << k;
      }
    }
  }
}

TEST(Gaps, AFunctionOfTheBasisIsFoundExactly) {
  // Least squares of samples without noise is exact, whichever are left. The prior adds its bias.
  Synthesizer engine(settings_of(8, 8));
  const auto f = [](double x, double y) {
    return 2 + std::cos(std::numbers::pi * x / 8) - 0.5 * std::cos(std::numbers::pi * y / 8);
  };
  engine.run([&](double x, double y) { return is_bad(x, y, 3, 7) ? nan : f(x, y); },
             {.samples_per_pixel = 6});
  ASSERT_GT(engine.stats().bad_samples, 80u);
  const FrequencyImage image = engine.image();
  const auto coefficients = image.coefficients(0, 0, 0);
  const double expected[] = {16, 8 / std::numbers::sqrt2, -4 / std::numbers::sqrt2};
  for (std::size_t i = 0; i < max_terms; ++i) {
    EXPECT_NEAR(coefficients[i], i < 3 ? expected[i] : 0, 0.02) << "term " << i;
  }
}

TEST(Gaps, WithoutAnyValueAreNothing) {
  Synthesizer engine(settings_of(24, 24));
  // The block in the middle has none but one, which comes late.
  const auto hole = [](double x, double y) {
    return x >= 8 && x <= 16 && y >= 8 && y <= 16 && !(x == 11 && y == 13);
  };
  engine.run([&](double x, double y) { return hole(x, y) ? nan : 3.0; }, {.samples_per_pixel = 16});
  const std::vector<std::uint32_t> counts = helpers::counts_of(engine.image());
  const double rounding = 3 * helpers::tolerance(*std::max_element(counts.begin(), counts.end()));
  for (const float pixel : reconstruct(engine.finished_image())) {
    EXPECT_TRUE(std::abs(pixel - 3) < rounding || pixel == 0) << pixel;
  }
}

}  // namespace
}  // namespace freqsynth
