// SPDX-License-Identifier: MIT
#include "baselines/filter.h"

#include <gtest/gtest.h>

#include "baseline_helpers.h"

namespace baselines {
namespace {

constexpr PixelFilter filters[] = {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian,
                                   PixelFilter::mitchell_netravali};

TEST(PixelFilter, IsEvenAndEndsAtItsRadius) {
  for (const PixelFilter filter : filters) {
    for (double x = 0; x < 3; x += 0.01) {
      EXPECT_EQ(weight(filter, x), weight(filter, -x));
      if (x > radius(filter)) {
        EXPECT_EQ(weight(filter, x), 0) << x;
      }
    }
    EXPECT_GT(weight(filter, 0), 0);
    if (filter != PixelFilter::box) {
      EXPECT_NEAR(weight(filter, radius(filter)), 0, 1e-12);
    }
  }
}

TEST(PixelFilter, HasTheClosedForms) {
  EXPECT_EQ(weight(PixelFilter::box, 0.49), 1);
  EXPECT_DOUBLE_EQ(weight(PixelFilter::tent, 0.25), 0.75);
  EXPECT_NEAR(weight(PixelFilter::gaussian, 0.5),
              std::exp(-0.5 * 0.25 / 0.25) - std::exp(-0.5 * 2.25 / 0.25), 1e-15);
  // From the paper's table of B = C = 1/3: 8/9 at the centre, 1/18 at 1, smooth everywhere.
  EXPECT_NEAR(weight(PixelFilter::mitchell_netravali, 0), 8.0 / 9, 1e-15);
  EXPECT_NEAR(weight(PixelFilter::mitchell_netravali, 1), 1.0 / 18, 1e-15);
  EXPECT_NEAR(weight(PixelFilter::mitchell_netravali, 1 + 1e-9), 1.0 / 18, 1e-8);
  EXPECT_LT(weight(PixelFilter::mitchell_netravali, 1.5), 0);
}

TEST(PixelFilter, MitchellNetravaliKeepsConstants) {
  // Its shifts by whole pixels sum to 1 at any position.
  for (double x = 0; x < 1; x += 0.013) {
    double sum = 0;
    for (int shift = -3; shift <= 3; ++shift) {
      sum += weight(PixelFilter::mitchell_netravali, x + shift);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

std::vector<Sample> scattered(std::size_t count, double width, double height) {
  Random random(5);
  std::vector<Sample> samples(count);
  for (Sample& sample : samples) {
    sample.x = random.uniform() * width;
    sample.y = random.uniform() * height;
    for (float& value : sample.rgb) value = static_cast<float>(random.uniform());
  }
  return samples;
}

TEST(WeightedAverage, IsTheAverageOverAllSamples) {
  const std::vector<Sample> samples = scattered(1500, 13, 9);
  for (const PixelFilter filter : filters) {
    for (const float width : {1.0f, 1.7f, 4.0f}) {
      Rendering rendering = grey_picture(13, 9, 0);
      weighted_average(samples, filter, {&width, 1}, rendering);
      for (std::size_t pixel = 0; pixel < 13 * 9; ++pixel) {
        const double x = static_cast<double>(pixel % 13) + 0.5;
        const double y = static_cast<double>(pixel / 13) + 0.5;
        double sum = 0;
        double weights = 0;
        for (const Sample& sample : samples) {
          const double w = weight(filter, (sample.x - x) / static_cast<double>(width)) *
                           weight(filter, (sample.y - y) / static_cast<double>(width));
          sum += w * static_cast<double>(sample.rgb[1]);
          weights += w;
        }
        ASSERT_NEAR(rendering.pixels[pixel * 3 + 1], sum / weights, 1e-5) << pixel;
      }
    }
  }
}

TEST(WeightedAverage, EachPixelHasItsWidth) {
  const std::vector<Sample> samples = scattered(800, 8, 8);
  std::vector<float> widths(64, 1);
  widths[27] = 3;
  Rendering mixed = grey_picture(8, 8, 0);
  Rendering narrow = mixed;
  Rendering wide = mixed;
  weighted_average(samples, PixelFilter::tent, widths, mixed);
  weighted_average(samples, PixelFilter::tent, {&widths[0], 1}, narrow);
  weighted_average(samples, PixelFilter::tent, {&widths[27], 1}, wide);
  for (std::size_t i = 0; i < mixed.pixels.size(); ++i) {
    EXPECT_EQ(mixed.pixels[i], i / 3 == 27 ? wide.pixels[i] : narrow.pixels[i]);
  }
  EXPECT_NE(wide.pixels[27 * 3], narrow.pixels[27 * 3]);
}

TEST(WeightedAverage, OneSampleFillsTheImage) {
  const Sample sample{0.25, 8.5, {1, 2, 3}};
  for (const PixelFilter filter : filters) {
    Rendering rendering = grey_picture(11, 9, 0);
    const float width = 1;
    weighted_average({&sample, 1}, filter, {&width, 1}, rendering);
    for (std::size_t pixel = 0; pixel < 99; ++pixel) {
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(rendering.pixels[pixel * 3 + c], sample.rgb[c], 1e-6);
      }
    }
  }
}

TEST(WidthForRate, LeavesTheAreaOfOneSample) {
  EXPECT_EQ(width_for_rate(1), 1);
  EXPECT_EQ(width_for_rate(9), 1);
  EXPECT_DOUBLE_EQ(width_for_rate(0.25), 2);
  EXPECT_DOUBLE_EQ(width_for_rate(1.0 / 16), 4);
}

}  // namespace
}  // namespace baselines
