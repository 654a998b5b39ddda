// SPDX-License-Identifier: MIT
// Features of the smoothing of noise of which pixels keep means.
#include "freqsynth/image/smoothing_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/freqsynth.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

struct Point {
  double x, y;
  float value;
};

/// The rules, pixel by pixel from all samples, in the host's unit.
struct ByRule {
  const std::vector<Point>& points;
  int width, height;

  /// Samples in the pixels up to `reach` away, but for the inner one if so wished: number and sum.
  [[nodiscard]] std::pair<double, double> all(int x, int y, int reach, bool inner) const {
    double count = 0, sum = 0;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v) {
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u) {
        if (!inner && u == x && v == y) continue;
        for (const Point& one : points) {
          if (one.x < u || one.x > u + 1 || one.y < v || one.y > v + 1) continue;
          count += 1;
          sum += double{one.value};
        }
      }
    }
    return {count, sum};
  }
  [[nodiscard]] double mean(int x, int y) const {
    for (int reach = 0; reach <= 8; ++reach) {
      const auto [count, sum] = all(x, y, reach, true);
      if (count > 0) return sum / count;
    }
    return 0;
  }
};

TEST(MeanFeature, HasMeansAndWhatTheirDifferencesTell) {
  // The last column and the last row of blocks are narrow.
  constexpr int width = 21, height = 11;
  constexpr double doubt = 0.7;
  const BlockGrid grid = BlockGrid::of(width, height, 1);
  const std::array roles{ChannelRole::nearest, ChannelRole::mean_feature, ChannelRole::mean};
  for (const float scale : {1.0f, 1e34f, 1e-37f}) {
    PixelStore store(grid, roles);
    std::vector<Point> points;
    oracle::Random random(5);
    for (int i = 0; i < 150; ++i) {
      const double x = random.uniform(0, width), y = random.uniform(0, height);
      const auto value = static_cast<float>(y > 5 ? 3 + x : random.uniform(-2, 2)) * scale;
      points.push_back({x, y, value});
      const std::array<float, 3> values{0, value, 7};
      ASSERT_TRUE(store.add({x, y}, values.data()));
    }
    const PixelStore some = store.part(ChannelRole::mean_feature);
    ASSERT_EQ(some.channels(), 1u);
    const detail::MeanFeature feature = detail::mean_feature(grid, some, 0, doubt);
    const ByRule rule{points, width, height};
    double largest = 0;
    for (int p = 0; p < width * height; ++p) {
      largest = std::max(largest, std::abs(rule.mean(p % width, p / width)));
    }
    const double unit = std::exp2(std::floor(std::log2(largest)));
    ASSERT_EQ(feature.means.size(), 24u * 16);
    ASSERT_EQ(feature.variances.size(), 6u);
    for (std::size_t block = 0; block < 6; ++block) {
      double squares = 0, pairs = 0;
      for (std::size_t cell = 0; cell < 64; ++cell) {
        const std::size_t left = block % 3 * 8, top = block / 3 * 8;
        const double across = (static_cast<double>(cell % 8) + 0.5) / 8;
        const double down = (static_cast<double>(cell / 8) + 0.5) / 8;
        const int x = static_cast<int>(left) +
                      static_cast<int>(across * std::min(8.0, width - static_cast<double>(left)));
        const int y = static_cast<int>(top) +
                      static_cast<int>(down * std::min(8.0, height - static_cast<double>(top)));
        const double mean = rule.mean(x, y) / unit;
        double pixel = mean;
        const auto [own, own_sum] = rule.all(x, y, 0, true);
        const auto [beside, beside_sum] = rule.all(x, y, 1, false);
        if (own > 0 && beside > 0) {
          const double other = beside_sum / beside / unit;
          pixel = (own_sum / unit + doubt * other) / (own + doubt);
          squares += std::pow(mean - other, 2) / (1 / own + 1 / beside);
          pairs += 1;
        }
        const std::size_t at = (top + cell / 8) * 24 + left + cell % 8;
        EXPECT_NEAR(double{feature.means[at]}, mean, 1e-6) << scale << ", " << block << ' ' << cell;
        EXPECT_NEAR(double{feature.pixels[at]}, pixel, 1e-6)
            << scale << ' ' << block << ' ' << cell;
      }
      ASSERT_GT(pairs, 0);
      EXPECT_NEAR(double{feature.variances[block]}, squares / pairs, 1e-5) << scale << ' ' << block;
    }
  }
}

TEST(MeanFeature, WithoutSamplesIsNothing) {
  const BlockGrid grid = BlockGrid::of(9, 8, 1);
  const std::array roles{ChannelRole::mean_feature};
  const PixelStore store(grid, roles);
  const detail::MeanFeature feature = detail::mean_feature(grid, store, 0, 0.5);
  EXPECT_EQ(feature.means, NoisyPicture::Plane(128, 0.0f));
  EXPECT_EQ(feature.pixels, feature.means);
  EXPECT_EQ(feature.variances, NoisyPicture::Plane(2, 0.0f));
}

/// Patches, which are seen in a feature, with noise on top of their light.
std::vector<float> noisy_patches(ChannelRole role, std::size_t width, std::size_t height) {
  Synthesizer engine({.width = width,
                      .height = height,
                      .channels = 2,
                      .noise = Noise::present,
                      .channel_settings = {{}, {role}}});
  engine.run(
      [](const Request& request) {
        const int patch = static_cast<int>(request.x / 5) * 7 + static_cast<int>(request.y / 6) * 3;
        const auto light = static_cast<float>(1 + patch % 4);
        const auto chance = static_cast<float>(request.seed >> 40) / 16777216.0f;
        return std::array<float, 2>{light * 2 * chance, light};
      },
      {.samples_per_pixel = 2});
  const FrequencyImage image = engine.finished_image();
  const std::vector<float> pixels = reconstruct(image);
  std::vector<float> light;
  for (std::size_t i = 0; i < pixels.size(); i += image.channels()) light.push_back(pixels[i]);
  std::vector<float> direct(width * height * image.channels());
  engine.finish({.data = direct.data(), .width = width, .height = height});
  EXPECT_EQ(direct, pixels);
  return light;
}

TEST(MeanFeature, GuidesTheSmoothing) {
  constexpr std::size_t width = 61, height = 44;
  const auto error_with = [&](ChannelRole role) {
    const std::vector<float> light = noisy_patches(role, width, height);
    double squares = 0;
    for (std::size_t p = 0; p < light.size(); ++p) {
      double truth = 0;
      for (int k = 0; k < 16; ++k) {
        const double x = static_cast<double>(p % width) + (k % 4 + 0.5) / 4;
        const double y = static_cast<double>(p / width) + (k / 4 + 0.5) / 4;
        truth += (1 + (static_cast<int>(x / 5) * 7 + static_cast<int>(y / 6) * 3) % 4) / 16.0;
      }
      squares += std::pow(double{light[p]} - truth, 2);
    }
    return std::sqrt(squares / static_cast<double>(light.size()));
  };
  const double without = error_with(ChannelRole::passive);
  const double fitted = error_with(ChannelRole::feature);
  const double means = error_with(ChannelRole::mean_feature);
  // Where every block has edges a fit guides better: .57 and .68 of the error without a feature.
  EXPECT_LT(fitted, 0.71 * without);
  EXPECT_LT(means, 0.85 * without);
  // A plain mean is no feature.
  EXPECT_EQ(noisy_patches(ChannelRole::mean, width, height),
            noisy_patches(ChannelRole::nearest, width, height));
}

}  // namespace
}  // namespace freqsynth
