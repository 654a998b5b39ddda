// SPDX-License-Identifier: MIT
#include "baselines/supersampling.h"

#include <gtest/gtest.h>

#include "baseline_helpers.h"

namespace baselines {
namespace {

TEST(Supersampling, AJitteredBoxIsTheMeanOfThePixelsSamples) {
  std::vector<double> sums(12, 0.0);
  const Radiance radiance = [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    const float value = static_cast<float>(id % 17);
    std::fill(rgb.begin(), rgb.end(), value);
    sums[static_cast<std::size_t>(y) * 4 + static_cast<std::size_t>(x)] +=
        static_cast<double>(value) / 6;
  };
  const Rendering rendering = supersampling(radiance, {4, 3, 72, 3});
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(rendering.pixels[i * 3], sums[i], 1e-5);
}

TEST(Supersampling, ErrorOfALinearRampIsThatOfItsStrata) {
  // With n x n strata in a pixel, each sample misses the mean of its stratum by a uniform deviate
  // of 1 / n: the mean of n * n has the variance 1 / (12 n^4), and none is further off than
  // 1 / (2 n).
  const auto ramp = [](double x, double) { return x; };
  for (const std::uint64_t n : {1u, 2u, 4u}) {
    const Rendering rendering = supersampling(grey(ramp), {64, 64, 64 * 64 * n * n, 2});
    double sum = 0;
    for (std::size_t i = 0; i < 64 * 64; ++i) {
      const double error =
          static_cast<double>(rendering.pixels[i * 3]) - (static_cast<double>(i % 64) + 0.5);
      ASSERT_LE(std::abs(error), 0.5 / static_cast<double>(n) + 1e-5);
      sum += error * error;
    }
    const double expected = 1 / (12 * std::pow(static_cast<double>(n), 4));
    // The relative deviation of a variance from 4096 pixels is below sqrt(2 / 4096).
    EXPECT_NEAR(sum / 4096, expected, 0.11 * expected) << n;
  }
}

TEST(Supersampling, ARegularGridIsExactOnALinearRamp) {
  const auto ramp = [](double x, double y) { return 2 * x + y; };
  const Rendering rendering = supersampling(grey(ramp), {9, 7, 9 * 7 * 6, 0}, {.jittered = false});
  EXPECT_LT(rms_error(rendering, pixel_means(9, 7, ramp)), 1e-5);
}

TEST(Supersampling, SpreadsFractionalRatesEvenly) {
  for (const double rate : {1.5, 2.3, 5.7}) {
    const Rendering rendering = supersampling(constant(1, 1, 1), job_at(64, 48, rate));
    for (const std::uint32_t count : rendering.samples) {
      // Strata are nearly square and have equal areas, so that a pixel meets no more than this.
      ASSERT_LE(count, std::pow(std::ceil(std::sqrt(rate)) + 1.5, 2));
    }
    // In 8 x 8 pixels only strata on the border can be in or out.
    for (std::size_t y = 0; y < 48; y += 8) {
      for (std::size_t x = 0; x < 64; x += 8) {
        double count = 0;
        for (std::size_t i = 0; i < 64; ++i)
          count += rendering.samples[(y + i / 8) * 64 + x + i % 8];
        EXPECT_NEAR(count, 64 * rate, 4 * 8 * std::sqrt(rate) + 4);
      }
    }
  }
}

TEST(Supersampling, BelowOneSamplePerPixelEveryBlockHasItsShare) {
  // 1/4: strata of 2 x 2 pixels.
  const Rendering rendering = supersampling(constant(1, 1, 1), job_at(32, 32, 0.25));
  for (std::size_t y = 0; y < 32; y += 2) {
    for (std::size_t x = 0; x < 32; x += 2) {
      EXPECT_EQ(rendering.samples[y * 32 + x] + rendering.samples[y * 32 + x + 1] +
                    rendering.samples[(y + 1) * 32 + x] + rendering.samples[(y + 1) * 32 + x + 1],
                1U);
    }
  }
}

}  // namespace
}  // namespace baselines
