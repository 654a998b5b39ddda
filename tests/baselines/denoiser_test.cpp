// SPDX-License-Identifier: MIT
// The pixels that denoisers start from, non-local means, and regression on features.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "baseline_helpers.h"
#include "baselines/feature_regression.h"
#include "baselines/low_discrepancy.h"
#include "baselines/non_local_means.h"
#include "baselines/pixel_buffers.h"

namespace baselines {
namespace {

Buffer random_buffer(std::size_t width, std::size_t height, std::size_t channels, unsigned seed,
                     float least = 0, float most = 1) {
  Buffer buffer{width, height, channels, {}};
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(least, most);
  for (std::size_t i = 0; i < width * height * channels; ++i) {
    buffer.values.push_back(uniform(random));
  }
  return buffer;
}

Buffer constant_buffer(std::size_t width, std::size_t height, std::size_t channels, float value) {
  return {width, height, channels, std::vector<float>(width * height * channels, value)};
}

double rms_of(std::span<const float> values, const std::function<double(std::size_t)>& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += std::pow(double{values[i]} - expected(i), 2);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// 0.5 and independent noise, uniform within 0.5 of it, that depends on the id alone.
void noise(double, double, std::uint64_t id, std::span<float, 3> rgb) {
  const double value = static_cast<double>(scatter(id) >> 11) * 0x1p-53;
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(value));
}

TEST(PixelBuffers, BoxMeansAreThoseOfWhatLiesInTheImage) {
  const Buffer buffer = random_buffer(9, 7, 2, 1);
  for (const std::size_t radius : {0u, 1u, 3u, 20u}) {
    const Buffer means = box_mean(buffer, radius);
    for (std::size_t i = 0; i < means.values.size(); ++i) {
      const std::size_t x = i / 2 % 9, y = i / 18;
      double sum = 0, count = 0;
      for (std::size_t j = 0; j < 9 * 7; ++j) {
        if (std::max(j % 9, x) - std::min(j % 9, x) > radius) continue;
        if (std::max(j / 9, y) - std::min(j / 9, y) > radius) continue;
        sum += double{buffer.values[2 * j + i % 2]};
        count += 1;
      }
      ASSERT_NEAR(means.values[i], sum / count, 1e-6) << radius << ' ' << i;
    }
  }
}

TEST(PixelBuffers, HalvesAreMeansOfAsManySamples) {
  // Counts of its calls in a pixel as values: 0, 1, 2 | 3, 4, 5, 6.
  const Radiance radiance = [](double, double, std::uint64_t id, std::span<float, 3> rgb) {
    std::fill(rgb.begin(), rgb.end(), static_cast<float>(id & 0xffffff));
  };
  const Job job = job_at(5, 4, 7);
  Sampler sampler(radiance, job);
  const PixelBuffers buffers = sample_pixels(sampler, job);
  for (const float value : buffers.half[0].values) EXPECT_FLOAT_EQ(value, 1);
  for (const float value : buffers.half[1].values) EXPECT_FLOAT_EQ(value, 4.5);
  // The halves say what the variance is: half of 3.5 squared.
  for (const float value : buffers.variance.values) EXPECT_NEAR(value, 6.125, 1e-4);
}

TEST(PixelBuffers, VarianceIsThatOfAHalf) {
  for (const int samples : {2, 8}) {
    const Job job = job_at(64, 64, samples);
    const Radiance radiance = noise;
    Sampler sampler(radiance, job);
    const PixelBuffers buffers = sample_pixels(sampler, job);
    double told = 0;
    for (const float value : buffers.variance.values) told += double{value} / (3 * 64 * 64);
    const double is = std::pow(rms_of(buffers.half[0].values, [](auto) { return 0.5; }), 2);
    // 1/12 for a number in 0..1. Of 4096 the variance is known to about 2 percent.
    EXPECT_NEAR(is * samples / 2, 1.0 / 12, 0.1 / 12);
    EXPECT_NEAR(told * samples / 2, 1.0 / 12, 0.1 / 12);
  }
}

TEST(PixelBuffers, OneSampleHasTheVarianceOfThoseAround) {
  const Radiance checker =
      grey([](double x, double y) { return std::fmod(std::floor(x) + std::floor(y), 2.0); });
  const Job job = job_at(6, 6, 1);
  Sampler sampler(checker, job);
  const PixelBuffers buffers = sample_pixels(sampler, job);
  EXPECT_EQ(buffers.half[0].values, buffers.half[1].values);
  EXPECT_NEAR(buffers.variance.values[3 * (2 * 6 + 3)], 20.0 / 81, 1e-6)
      << "5 of one, 4 of another";
  EXPECT_NEAR(buffers.variance.values[0], 0.25, 1e-6) << "two of each in the corner";
}

/// The weight of pixel p for q by the paper's formula, patches cut off at the border.
double weight_of(const Buffer& guide, const Buffer& variance, const NonLocalMeansSettings& settings,
                 std::array<int, 2> p, std::array<int, 2> q) {
  const auto width = static_cast<int>(guide.width), height = static_cast<int>(guide.height);
  const auto patch = static_cast<int>(settings.patch), channels = static_cast<int>(guide.channels);
  const auto inside = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height; };
  double sum = 0, count = 0;
  for (int j = -patch; j <= patch; ++j) {
    for (int i = -patch; i <= patch; ++i) {
      if (!inside(p[0] + i, p[1] + j) || !inside(q[0] + i, q[1] + j)) continue;
      for (int c = 0; c < channels; ++c) {
        const auto at = [&](const Buffer& buffer, const std::array<int, 2>& pixel) {
          const int index = ((pixel[1] + j) * width + pixel[0] + i) * channels + c;
          return double{buffer.values[static_cast<std::size_t>(index)]};
        };
        const double a = at(variance, p), b = at(variance, q);
        const double difference = at(guide, p) - at(guide, q);
        sum += (difference * difference - (a + std::min(a, b))) /
               (1e-10 + settings.k * settings.k * (a + b));
        count += 1;
      }
    }
  }
  return std::exp(-std::max(0.0, sum / count));
}

TEST(NonLocalMeans, WeightsAreThoseOfTheFormula) {
  const NonLocalMeansSettings settings{.search = 3, .patch = 2, .k = 0.7};
  const Buffer guide = random_buffer(11, 9, 3, 2);
  const Buffer variance = random_buffer(11, 9, 3, 3, 0.02f, 0.3f);
  int offsets = 0;
  for_each_weight(guide, variance, settings,
                  [&](std::ptrdiff_t dx, std::ptrdiff_t dy, std::span<const float> weights) {
                    ++offsets;
                    for (int i = 0; i < 11 * 9; ++i) {
                      const std::array p{i % 11, i / 11};
                      const std::array q{p[0] + static_cast<int>(dx), p[1] + static_cast<int>(dy)};
                      const bool inside = q[0] >= 0 && q[1] >= 0 && q[0] < 11 && q[1] < 9;
                      const double expected =
                          inside ? weight_of(guide, variance, settings, p, q) : 0;
                      ASSERT_NEAR(weights[static_cast<std::size_t>(i)], expected, 1e-4)
                          << i << ' ' << dx << ' ' << dy;
                    }
                  });
  EXPECT_EQ(offsets, 49);
}

TEST(NonLocalMeans, FilteredIsTheWeightedMean) {
  const NonLocalMeansSettings settings{.search = 2, .patch = 1, .k = 1};
  const Buffer source = random_buffer(8, 7, 2, 4);
  const Buffer guide = random_buffer(8, 7, 3, 5);
  const Buffer variance = random_buffer(8, 7, 3, 6, 0.05f, 0.2f);
  const Buffer result = filtered(source, guide, variance, settings);
  for (int p = 0; p < 56; ++p) {
    double sum = 0, weights = 0;
    for (int q = 0; q < 56; ++q) {
      if (std::abs(p % 8 - q % 8) > 2 || std::abs(p / 8 - q / 8) > 2) continue;
      const double weight = weight_of(guide, variance, settings, {p % 8, p / 8}, {q % 8, q / 8});
      sum += weight * double{source.values[static_cast<std::size_t>(2 * q + 1)]};
      weights += weight;
    }
    EXPECT_NEAR(result.values[static_cast<std::size_t>(2 * p + 1)], sum / weights, 1e-5) << p;
  }
}

TEST(NonLocalMeans, KeepsAnEdgeAndTakesNoiseAway) {
  // Noise of a tenth on both sides of an edge.
  const auto edge = [](double x) { return x < 24 ? 0.2 : 0.8; };
  const Radiance radiance = [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    noise(x, y, id, rgb);
    for (float& value : rgb) value = static_cast<float>(edge(x) + 0.2 * (double{value} - 0.5));
  };
  const Job job = job_at(48, 48, 4);
  const auto expected = [&](std::size_t i) { return edge(static_cast<double>(i / 3 % 48)); };
  const double before = rms_of(sobol_box(radiance, job).pixels, expected);
  const double after = rms_of(non_local_means(radiance, job).pixels, expected);
  EXPECT_NEAR(before, 0.2 / std::sqrt(12.0 * 4), 0.1 * before);
  EXPECT_LT(after, before / 5);
}

/// Solves a symmetric system by elimination with pivots.
std::vector<double> solution(std::vector<std::vector<double>> a) {
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 1; k < n; ++k) {
      if (std::abs(a[k][i]) > std::abs(a[i][i])) std::swap(a[i], a[k]);
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (k == i) continue;
      const double factor = a[k][i] / a[i][i];
      for (std::size_t j = i; j <= n; ++j) a[k][j] -= factor * a[i][j];
    }
  }
  std::vector<double> x;
  for (std::size_t i = 0; i < n; ++i) x.push_back(a[i][n] / a[i][i]);
  return x;
}

TEST(FeatureRegression, IsTheWeightedMeanOfAllFits) {
  const NonLocalMeansSettings settings{.search = 2, .patch = 1, .k = 1.5};
  constexpr int width = 8, height = 7;
  const Buffer source = random_buffer(width, height, 3, 7);
  const Buffer guide = random_buffer(width, height, 3, 8);
  const Buffer variance = random_buffer(width, height, 3, 9, 0.1f, 0.3f);
  const Buffer features = random_buffer(width, height, 2, 10);
  const Buffer result = regressed(source, guide, variance, features, settings);

  std::vector<double> sums(width * height), weights(width * height);
  const auto feature = [&](int pixel, int i) {
    return double{features.values[static_cast<std::size_t>(2 * pixel + i)]};
  };
  for (int p = 0; p < width * height; ++p) {
    const auto for_window = [&](const auto& visit) {
      for (int q = 0; q < width * height; ++q) {
        if (std::abs(p % width - q % width) > 2 || std::abs(p / width - q / width) > 2) continue;
        visit(q,
              weight_of(guide, variance, settings, {p % width, p / width}, {q % width, q / width}));
      }
    };
    std::vector<std::vector<double>> normal(3, std::vector<double>(4));
    for_window([&](int q, double weight) {
      const std::array<double, 4> row{1, feature(q, 0), feature(q, 1),
                                      double{source.values[static_cast<std::size_t>(3 * q)]}};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) normal[i][j] += weight * row[i] * row[j];
      }
    });
    const std::vector<double> fit = solution(normal);
    for_window([&](int q, double weight) {
      const auto at = static_cast<std::size_t>(q);
      sums[at] += weight * (fit[0] + fit[1] * feature(q, 0) + fit[2] * feature(q, 1));
      weights[at] += weight;
    });
  }
  for (std::size_t q = 0; q < sums.size(); ++q) {
    EXPECT_NEAR(result.values[3 * q], sums[q] / weights[q], 1e-4) << q;
  }
}

TEST(FeatureRegression, IsExactForColoursThatAreAffineInTheFeatures) {
  const Buffer features = random_buffer(24, 20, 7, 11);
  Buffer source = constant_buffer(24, 20, 3, 0);
  for (std::size_t i = 0; i < source.values.size(); ++i) {
    const float* f = &features.values[i / 3 * 7];
    source.values[i] = 0.3f + 0.7f * f[i % 3] - 0.2f * f[4] + 0.4f * f[6];
  }
  // Whatever the weights are.
  const Buffer result = regressed(source, random_buffer(24, 20, 3, 12),
                                  constant_buffer(24, 20, 3, 0.2f), features, {.search = 6});
  EXPECT_LT(rms_of(result.values, [&](std::size_t i) { return double{source.values[i]}; }), 1e-4);
}

/// Tiles of random colours under a light that fades, with noise as of noise().
Job tiles(std::size_t width, std::size_t height, int rate, double amplitude) {
  Job job = job_at(width, height, rate);
  job.features = 7;
  job.radiance_and_features = [amplitude](double x, double y, std::uint64_t id,
                                          std::span<float> values) {
    std::array<float, 3> random{};
    noise(x, y, id, random);
    std::fill(values.begin(), values.end(), 0.0f);
    const auto tile = static_cast<std::uint64_t>(x / 3) + 1000 * static_cast<std::uint64_t>(y / 3);
    for (std::size_t c = 0; c < 3; ++c) {
      values[3 + c] = static_cast<float>(scatter(3 * tile + c) >> 40) * 0x1p-24f;
      values[c] =
          0.1f + 0.8f * values[3 + c] + static_cast<float>(amplitude * (double{random[c]} - 0.5));
    }
    values[8] = 1;
    values[9] = 0.25f;
  };
  return job;
}

TEST(FeatureRegression, FollowsFeaturesThroughNoise) {
  const auto radiance_of = [](const Job& job) -> Radiance {
    return [&job](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
      std::array<float, 10> values{};
      job.radiance_and_features(x, y, id, values);
      std::copy_n(values.begin(), 3, rgb.begin());
    };
  };
  const Job clear = tiles(48, 36, 4, 0);
  const std::vector<float> truth = sobol_box(radiance_of(clear), clear).pixels;
  const auto expected = [&](std::size_t i) { return double{truth[i]}; };
  EXPECT_LT(rms_of(feature_regression(radiance_of(clear), clear).pixels, expected), 1e-4);

  const Job job = tiles(48, 36, 4, 1.0);
  const Radiance radiance = radiance_of(job);
  const double plain = rms_of(sobol_box(radiance, job).pixels, expected);
  const double alike = rms_of(non_local_means(radiance, job).pixels, expected);
  EXPECT_NEAR(plain, 1 / std::sqrt(12.0 * 4), 0.1 * plain);
  EXPECT_LT(rms_of(feature_regression(radiance, job).pixels, expected), 0.5 * alike);
}

TEST(Denoisers, AreTheBoxAloneBelowOneSamplePerPixel) {
  const Radiance radiance = grey(slanted_edge);
  const Job job = job_at(20, 16, 0.9);
  const std::vector<float> box = sobol_box(radiance, job).pixels;
  EXPECT_EQ(non_local_means(radiance, job).pixels, box);
  EXPECT_EQ(feature_regression(radiance, job).pixels, box);
}

}  // namespace
}  // namespace baselines
