// SPDX-License-Identifier: MIT
// SSIM against closed forms and against a slow computation that follows the definition.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "metric_helpers.h"
#include "quality/metrics.h"

namespace {

using metric_helpers::linear_of;
using metric_helpers::noise;
using metric_helpers::Picture;

TEST(Metrics, SsimOfEqualPicturesIsOne) {
  const Picture picture = noise(40, 23, 2);
  EXPECT_NEAR(quality::ssim(picture, picture), 1, 1e-9);
}

TEST(Metrics, SsimOfTwoConstants) {
  // No variance: only the term of the means is left.
  const double a = 90;
  const double b = 150;
  const double c1 = 2.55 * 2.55;
  EXPECT_NEAR(quality::ssim(Picture(20, 20, linear_of(a)), Picture(20, 20, linear_of(b))),
              (2 * a * b + c1) / (a * a + b * b + c1), 1e-5);
}

TEST(Metrics, SsimOfACheckerboardAndItsNegativeIsNegative) {
  // The means are equal, both variances are 65^2, and the covariance is minus that.
  Picture picture(32, 32);
  Picture negative(32, 32);
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 32; ++x) {
      picture.set(x, y, linear_of((x + y) % 2 == 0 ? 60 : 190));
      negative.set(x, y, linear_of((x + y) % 2 == 0 ? 190 : 60));
    }
  }
  const double variance = 65 * 65;
  const double c2 = 7.65 * 7.65;
  EXPECT_NEAR(quality::ssim(picture, negative), (c2 - 2 * variance) / (c2 + 2 * variance), 1e-4);
}

/// By the definition: all 121 weights for each window, the variance from differences to the mean.
double slow_ssim(const Picture& picture, const Picture& reference) {
  const auto encoded_luma = [](const Picture& from, std::size_t pixel) {
    std::array<double, 3> encoded{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double x = std::fmin(std::fmax(double{from.pixels[3 * pixel + c]}, 0), 1);
      encoded[c] = 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
    }
    return 0.299 * encoded[0] + 0.587 * encoded[1] + 0.114 * encoded[2];
  };
  std::array<double, 121> weights{};
  double total = 0;
  for (int i = 0; i < 121; ++i) {
    const int dx = i % 11 - 5;
    const int dy = i / 11 - 5;
    total += weights[static_cast<std::size_t>(i)] = std::exp(-(dx * dx + dy * dy) / 4.5);
  }
  double sum = 0;
  double windows = 0;
  for (std::size_t y = 0; y + 11 <= picture.height; ++y) {
    for (std::size_t x = 0; x + 11 <= picture.width; ++x) {
      std::array<double, 121> a{}, b{};
      double mean_a = 0;
      double mean_b = 0;
      for (std::size_t i = 0; i < 121; ++i) {
        const std::size_t pixel = (y + i / 11) * picture.width + x + i % 11;
        a[i] = encoded_luma(picture, pixel);
        b[i] = encoded_luma(reference, pixel);
        mean_a += weights[i] / total * a[i];
        mean_b += weights[i] / total * b[i];
      }
      double var_a = 0;
      double var_b = 0;
      double covariance = 0;
      for (std::size_t i = 0; i < 121; ++i) {
        var_a += weights[i] / total * (a[i] - mean_a) * (a[i] - mean_a);
        var_b += weights[i] / total * (b[i] - mean_b) * (b[i] - mean_b);
        covariance += weights[i] / total * (a[i] - mean_a) * (b[i] - mean_b);
      }
      const double c1 = 2.55 * 2.55;
      const double c2 = 7.65 * 7.65;
      sum += (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
             ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
      windows += 1;
    }
  }
  return sum / windows;
}

TEST(Metrics, SsimAgreesWithTheDefinition) {
  for (const auto& [width, height] : {std::pair{11, 11}, {12, 30}, {33, 17}}) {
    const auto w = static_cast<std::size_t>(width);
    const auto h = static_cast<std::size_t>(height);
    const Picture reference = noise(w, h, 3);
    Picture picture = reference;
    const Picture error = noise(w, h, 4, -0.3f, 0.3f);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] += error.pixels[i];
    const double expected = slow_ssim(picture, reference);
    EXPECT_GT(expected, 0.1);
    EXPECT_LT(expected, 0.95);
    EXPECT_NEAR(quality::ssim(picture, reference), expected, 1e-9);
  }
}

TEST(Metrics, SsimNeedsAWindow) {
  EXPECT_THROW((void)quality::ssim(Picture(10, 20), Picture(10, 20)), std::invalid_argument);
  EXPECT_THROW((void)quality::ssim(Picture(20, 10), Picture(20, 10)), std::invalid_argument);
}

}  // namespace
