// SPDX-License-Identifier: MIT
// Only where there is OpenCV. What all methods have in common is tested with the others.
#ifdef FREQSYNTH_BASELINES_OPENCV
#include "baselines/opencv_fsr.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "baseline_helpers.h"
#include "baselines/supersampling.h"

namespace baselines {
namespace {

TEST(SpreadPixels, AreDistinctAscendingAndAsManyAsAllowed) {
  struct Size {
    std::size_t width, height;
  };
  for (const auto& [width, height] : {Size{37, 21}, {1, 40}, {40, 1}, {16, 16}, {2, 1}}) {
    const std::uint64_t pixels = width * height;
    for (const std::uint64_t samples : {std::uint64_t{1}, pixels / 3, pixels / 2, pixels - 1}) {
      if (samples == 0) continue;
      const std::vector<std::size_t> chosen = spread_pixels({width, height, samples, 5});
      ASSERT_EQ(chosen.size(), samples) << width << ' ' << samples;
      ASSERT_EQ(std::adjacent_find(chosen.begin(), chosen.end(), std::greater_equal()),
                chosen.end());
      ASSERT_LT(chosen.back(), pixels);
    }
  }
}

TEST(SpreadPixels, AreSpreadEvenly) {
  // Strata of 4 x 4 pixels, one pixel in each.
  const std::vector<std::size_t> sparse = spread_pixels({64, 32, 128, 1});
  std::set<std::size_t> strata;
  for (const std::size_t pixel : sparse) strata.insert(pixel / 64 / 4 * 16 + pixel % 64 / 4);
  EXPECT_EQ(strata.size(), 128u);
  // Strata smaller than 2 pixels meet in pixels, but what is displaced stays near.
  const std::vector<std::size_t> dense = spread_pixels({64, 64, 2458, 1});
  std::vector<int> counts(64, 0);
  for (const std::size_t pixel : dense) ++counts[pixel / 64 / 8 * 8 + pixel % 64 / 8];
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  EXPECT_GE(*least, 30);
  EXPECT_LE(*most, 47);
}

TEST(SpreadPixels, DependOnTheSeed) {
  EXPECT_EQ(spread_pixels({37, 21, 100, 1}), spread_pixels({37, 21, 100, 1}));
  EXPECT_NE(spread_pixels({37, 21, 100, 1}), spread_pixels({37, 21, 100, 2}));
}

TEST(OpencvFsr, SamplesTheCentresOfDistinctPixels) {
  const Job job = job_at(37, 21, 0.6);
  const Rendering rendering = opencv_fsr(
      [](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
        EXPECT_EQ(x - std::floor(x), 0.5);
        EXPECT_EQ(y - std::floor(y), 0.5);
        std::fill(rgb.begin(), rgb.end(), 0.5f);
      },
      job);
  EXPECT_EQ(total_samples(rendering), job.samples);
  EXPECT_EQ(*std::max_element(rendering.samples.begin(), rendering.samples.end()), 1u);
}

TEST(OpencvFsr, AConstantStaysConstantWithinTheStepsOf8Bits) {
  struct Size {
    std::size_t width, height;
  };
  for (const auto& [width, height] : {Size{37, 21}, {1, 1}, {1, 40}, {40, 1}, {16, 16}}) {
    for (const double rate : {1.0 / 64, 1.0 / 16, 0.25, 0.7}) {
      const Job job = job_at(width, height, rate);
      const Rendering rendering = opencv_fsr(constant(0.25f, 0.5f, 3), job);
      // What is beyond 1 is cut off where there are pixels to fill in.
      const double blue = job.samples < width * height ? 1 : 3;
      // Wider than a step, because the colour differences are rounded, too.
      for (std::size_t i = 0; i < width * height; ++i) {
        ASSERT_NEAR(rendering.pixels[i * 3], 0.25f, 0.016) << width << ' ' << rate << ' ' << i;
        ASSERT_NEAR(rendering.pixels[i * 3 + 1], 0.5f, 0.016) << width << ' ' << rate << ' ' << i;
        ASSERT_NEAR(rendering.pixels[i * 3 + 2], blue, 0.04) << width << ' ' << rate << ' ' << i;
      }
    }
  }
}

TEST(OpencvFsr, SampledPixelsKeepTheirValues) {
  const auto value = [](double x, double y) { return 0.5 + 0.7 * std::sin(0.3 * x + 0.2 * y); };
  const Rendering rendering = opencv_fsr(grey(value), job_at(32, 32, 0.4));
  for (std::size_t i = 0; i < rendering.samples.size(); ++i) {
    if (rendering.samples[i] == 0) continue;
    const double x = static_cast<double>(i % 32) + 0.5;
    const double y = static_cast<double>(i / 32) + 0.5;
    EXPECT_FLOAT_EQ(rendering.pixels[3 * i], static_cast<float>(std::clamp(value(x, y), 0.0, 1.0)));
  }
}

TEST(OpencvFsr, FillsInASmoothPictureUpToTheLastRowAndColumn) {
  const auto smooth = [](double x, double y) { return 0.5 + 0.3 * std::sin(0.15 * x + 0.1 * y); };
  const Rendering rendering = opencv_fsr(grey(smooth), job_at(37, 21, 0.25));
  const std::vector<double> means = pixel_means(37, 21, smooth);
  EXPECT_LT(rms_error(rendering, means), 0.03);
  for (std::size_t y = 0; y < 21; ++y) {
    for (std::size_t x = 0; x < 37; ++x) {
      if (x < 36 && y < 20) continue;
      EXPECT_NEAR(rendering.pixels[3 * (y * 37 + x)], means[y * 37 + x], 0.15) << x << ' ' << y;
    }
  }
}

TEST(OpencvFsr, IsSupersamplingFromOneSamplePerPixelOn) {
  for (const double rate : {1.0, 2.5}) {
    const Job job = job_at(37, 21, rate);
    EXPECT_EQ(opencv_fsr(grey(slanted_edge), job).pixels,
              supersampling(grey(slanted_edge), job).pixels);
  }
}

TEST(OpencvFsr, TooFewSamplesForOpencvAreAveraged) {
  const Job job{100, 60, 2, 1};
  const Rendering rendering = opencv_fsr(constant(0.25f, 0.5f, 3), job);
  EXPECT_EQ(total_samples(rendering), 2u);
  for (std::size_t i = 0; i < rendering.pixels.size(); i += 3) {
    ASSERT_NEAR(rendering.pixels[i], 0.25, 1e-6);
    ASSERT_NEAR(rendering.pixels[i + 2], 1, 1e-6);
  }
}

TEST(OpencvFsr, RadiancesThatAreNotNumbersDoNotSpread) {
  const Rendering rendering =
      opencv_fsr(grey([](double x, double y) { return x < 8 && y < 8 ? std::nan("") : 0.5; }),
                 job_at(32, 32, 0.25));
  for (const float value : rendering.pixels) ASSERT_TRUE(value >= 0 && value <= 1);
  EXPECT_NEAR(rendering.pixels[3 * (31 * 32 + 31)], 0.5, 0.05);
}

}  // namespace
}  // namespace baselines
#endif
