// SPDX-License-Identifier: MIT
#include "freqsynth/image/smooth_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "freqsynth/freqsynth.h"
#include "freqsynth/image/block_noise.h"

namespace freqsynth {
namespace {

using Plane = NoisyPicture::Plane;

/// One channel of the given pixels, each with `samples` samples that are the pixel and noise.
NoisyPicture noisy_picture(std::size_t width, std::size_t height, const Plane& right, float samples,
                           float noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 1);
  NoisyPicture picture;
  picture.width = width;
  picture.height = height;
  picture.weights.assign(width * height, samples);
  picture.pixels = {right};
  picture.sums = {right};
  picture.variances = {Plane(width * height / max_terms, noise * noise)};
  for (std::size_t i = 0; i < right.size(); ++i) {
    picture.pixels[0][i] += noise / std::sqrt(samples) * normal(random);
    picture.sums[0][i] = samples * picture.pixels[0][i];
  }
  return picture;
}

double sum_of(std::span<const float> plane) {
  return std::accumulate(plane.begin(), plane.end(), 0.0);
}

double rms(const Plane& a, const Plane& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

Plane levels(std::size_t width, std::size_t height, float step) {
  Plane plane(width * height);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    plane[i] = 1 + ((i % width / 8 + i / width / 8) % 2 == 0 ? step : 0);
  }
  return plane;
}

TEST(CloseBorders, LeavesRampsAlone) {
  Plane ramp(32 * 32);
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    ramp[i] = 0.25f * static_cast<float>(i % 32) - 0.5f * static_cast<float>(i / 32);
  }
  NoisyPicture picture = noisy_picture(32, 32, ramp, 1, 0, 1);
  for (float& sum : picture.sums[0]) sum += 3;  // as if there were noise
  detail::close_borders(picture, picture.sums[0], 1, picture.pixels[0]);
  EXPECT_LT(rms(picture.pixels[0], ramp), 1e-6);
}

TEST(CloseBorders, TakesStepsBackAsFarAsNoiseExplainsThem) {
  const Plane right = levels(64, 64, 0.5f);
  for (const float noise : {0.0f, 0.1f, 0.5f, 4.0f}) {
    NoisyPicture picture = noisy_picture(64, 64, right, 1, 0, 1);
    for (std::size_t i = 0; i < right.size(); ++i) {
      picture.sums[0][i] += (i / 64 + i % 64) % 2 == 0 ? noise : -noise;
    }
    detail::close_borders(picture, picture.sums[0], 1, picture.pixels[0]);
    const Plane& pixels = picture.pixels[0];
    // In the middle of a border, away from corners. Half of the step goes to each side, of which
    // the first pixel takes 7/8.
    const double step = 0.5, variance = double{noise} * double{noise};
    const double back = step * variance / (step * step + variance);
    // Three steps on either side count with falling weights, all alike here.
    EXPECT_NEAR(double{pixels[3 * 64 + 8]} - double{pixels[3 * 64 + 7]}, -step + 7.0 / 8 * back,
                2e-3 + 0.1 * back)
        << noise;
    EXPECT_NEAR(sum_of(pixels), sum_of(right), 1e-3);
  }
}

TEST(PoolLevels, BringsLevelsTogetherThatNoiseHasSetApart) {
  const Plane right(128 * 128, 1.0f);
  NoisyPicture picture = noisy_picture(128, 128, right, 1, 1, 5);
  // As a finish that knows the mean of each block, and no more.
  for (std::size_t y = 0; y < 128; y += 8) {
    for (std::size_t x = 0; x < 128; x += 8) {
      double mean = 0;
      for (std::size_t i = 0; i < 64; ++i)
        mean += picture.sums[0][(y + i / 8) * 128 + x + i % 8] / 64;
      for (std::size_t i = 0; i < 64; ++i) {
        picture.pixels[0][(y + i / 8) * 128 + x + i % 8] = static_cast<float>(mean);
      }
    }
  }
  const double before = rms(picture.pixels[0], right);
  const double sum = sum_of(picture.sums[0]);
  detail::pool_levels(picture, picture.sums[0], picture.sums[0], picture.pixels[0]);
  EXPECT_LT(rms(picture.pixels[0], right), 0.6 * before);
  EXPECT_NEAR(sum_of(picture.pixels[0]), sum, 0.002 * sum);
}

TEST(PoolLevels, LeavesLevelsThatSamplesAreSureOf) {
  const Plane right = levels(128, 128, 0.5f);
  for (const float noise : {0.0f, 0.1f}) {
    NoisyPicture picture = noisy_picture(128, 128, right, 4, noise, 6);
    picture.pixels[0] = right;
    detail::pool_levels(picture, picture.sums[0], picture.sums[0], picture.pixels[0]);
    EXPECT_LT(rms(picture.pixels[0], right), 0.004) << noise;
  }
}

TEST(SmoothNoise, TakesMostOfTheNoiseOfAFlatPicture) {
  const Plane right(128 * 128, 2.0f);
  NoisyPicture picture = noisy_picture(128, 128, right, 2, 0.5f, 7);
  const double before = rms(picture.pixels[0], right);
  smooth_noise(picture, std::vector<std::size_t>{0}, {});
  EXPECT_LT(rms(picture.pixels[0], right), 0.5 * before);
}

TEST(SmoothNoise, FeaturesKeepTheirEdges) {
  Plane right(128 * 128), feature(128 * 128);
  for (std::size_t i = 0; i < right.size(); ++i) {
    const double x = static_cast<double>(i % 128), y = static_cast<double>(i / 128);
    feature[i] = std::hypot(x - 60, y - 70) < 40 ? 1 : 0;
    right[i] = 1 + 3 * feature[i];
  }
  NoisyPicture with = noisy_picture(128, 128, right, 1, 0.3f, 8);
  // The blocks' own fits know the edge roughly: means of 5 x 5 pixels.
  const Plane sampled = with.pixels[0];
  for (std::size_t y = 2; y < 126; ++y) {
    for (std::size_t x = 2; x < 126; ++x) {
      double sum = 0;
      for (std::size_t k = 0; k < 25; ++k) {
        sum += double{sampled[(y + k / 5 - 2) * 128 + x + k % 5 - 2]};
      }
      with.pixels[0][y * 128 + x] = static_cast<float>(sum / 25);
    }
  }
  NoisyPicture without = with;
  with.sums.push_back(feature);
  with.pixels.push_back(feature);
  with.variances.emplace_back(with.variances[0].size());
  smooth_noise(with, std::vector<std::size_t>{0}, std::vector<std::size_t>{1});
  smooth_noise(without, std::vector<std::size_t>{0}, {});
  EXPECT_LT(rms(with.pixels[0], right), 0.1);
  EXPECT_GT(rms(without.pixels[0], right), 2 * rms(with.pixels[0], right));
  EXPECT_EQ(with.pixels[1], feature) << "features without noise stay";
}

// As colours seen through a lens: what such a feature has of its own noise is not to be seen.
TEST(SmoothNoise, FeaturesWithNoiseOfTheirOwnAddNone) {
  Plane right(128 * 128);
  for (std::size_t i = 0; i < right.size(); ++i) {
    right[i] = std::sin(0.2f * static_cast<float>(i % 128));
  }
  NoisyPicture without = noisy_picture(128, 128, right, 1, 1.5f, 10);
  NoisyPicture with = without;
  std::vector<std::size_t> features;
  for (unsigned f = 1; f <= 6; ++f) {
    const NoisyPicture feature = noisy_picture(128, 128, right, 1, 1.0f, 10 + f);
    with.sums.push_back(feature.sums[0]);
    with.pixels.push_back(feature.pixels[0]);
    with.variances.push_back(feature.variances[0]);
    features.push_back(f);
  }
  smooth_noise(with, std::vector<std::size_t>{0}, features);
  smooth_noise(without, std::vector<std::size_t>{0}, {});
  EXPECT_LT(rms(with.pixels[0], right), 1.05 * rms(without.pixels[0], right));
}

TEST(SmoothNoise, DoesNotDependOnTheUnit) {
  const Plane right = levels(64, 64, 0.5f);
  NoisyPicture picture = noisy_picture(64, 64, right, 2, 0.3f, 9);
  NoisyPicture scaled = picture;
  for (float& value : scaled.pixels[0]) value *= 0x1p40f;
  for (float& value : scaled.sums[0]) value *= 0x1p40f;
  for (float& value : scaled.variances[0]) value *= 0x1p80f;
  smooth_noise(picture, std::vector<std::size_t>{0}, {});
  smooth_noise(scaled, std::vector<std::size_t>{0}, {});
  for (std::size_t i = 0; i < right.size(); ++i) {
    ASSERT_EQ(scaled.pixels[0][i], 0x1p40f * picture.pixels[0][i]);
  }
}

TEST(SmoothNoise, WrongPicturesAreRefused) {
  const Plane right(64, 1.0f);
  const NoisyPicture good = noisy_picture(8, 8, right, 1, 0, 1);
  const std::vector<std::size_t> first{0}, second{1};
  NoisyPicture picture = good;
  EXPECT_THROW(smooth_noise(picture, second, {}), std::invalid_argument);
  EXPECT_THROW(smooth_noise(picture, first, second), std::invalid_argument);
  picture.weights.pop_back();
  EXPECT_THROW(smooth_noise(picture, first, {}), std::invalid_argument);
  picture = good;
  picture.variances[0].clear();
  EXPECT_THROW(smooth_noise(picture, first, {}), std::invalid_argument);
  picture = good;
  picture.sums.emplace_back(64);
  EXPECT_THROW(smooth_noise(picture, first, {}), std::invalid_argument);
  picture = good;
  picture.width = 4;
  picture.height = 16;
  EXPECT_THROW(smooth_noise(picture, first, {}), std::invalid_argument);
}

/// 1 / p with probability p, independent for each sample.
struct Bernoulli {
  double p;
  void operator()(std::span<const Request> requests, std::span<float> values) const {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      std::mt19937_64 random(requests[i].seed);
      const double uniform = static_cast<double>(random() >> 11) * 0x1p-53;
      values[i] = uniform < p ? static_cast<float>(1 / p) : 0.0f;
    }
  }
};

/// Mean of the picture over the mean of all samples.
double light_kept(double p, double rate, std::uint64_t seed, std::size_t width = 128,
                  std::size_t height = 128) {
  SynthesisSettings settings{
      .width = width, .height = height, .channels = 1, .noise = Noise::present};
  settings.seed = seed;
  Synthesizer engine(settings);
  double sum = 0, samples = 0;
  const Bernoulli bernoulli{p};
  engine.run(
      [&](std::span<const Request> requests, std::span<float> values) {
        bernoulli(requests, values);
        sum = std::accumulate(values.begin(), values.end(), sum);
        samples += static_cast<double>(values.size());
      },
      {.samples_per_pixel = rate});
  const std::vector<float> pixels = reconstruct(engine.finished_image());
  EXPECT_GE(*std::min_element(pixels.begin(), pixels.end()), -1e-4f);
  return sum_of(pixels) / static_cast<double>(pixels.size()) / (sum / samples);
}

TEST(SmoothNoise, KeepsTheLightOfRareSamples) {
  struct Case {
    double p, rate, least;
  };
  for (const Case& c :
       {Case{0.1, 1, 0.98}, Case{0.1, 4, 0.98}, Case{0.1, 16, 0.98}, Case{0.02, 1, 0.97},
        Case{0.02, 4, 0.98}, Case{0.005, 4, 0.95}, Case{0.005, 1, 0.75}}) {
    double kept = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) kept += light_kept(c.p, c.rate, seed) / 4;
    EXPECT_GT(kept, c.least) << c.p << " at " << c.rate;
    EXPECT_LT(kept, 1.02) << c.p << " at " << c.rate;
  }
}

TEST(SmoothNoise, KeepsTheLightOfPicturesOfAnySize) {
  std::mt19937 random(3);
  double kept = 0;
  constexpr int runs = 12;
  for (int run = 0; run < runs; ++run) {
    const double p = std::exp(std::uniform_real_distribution(std::log(0.02), 0.0)(random));
    const double rate = std::uniform_real_distribution(1.0, 4.0)(random);
    const std::size_t width = 40 + random() % 100, height = 40 + random() % 100;
    const double one = light_kept(p, rate, random(), width, height);
    EXPECT_NEAR(one, 1, 0.05) << p << " at " << rate << ", " << width << " x " << height;
    kept += one / runs;
  }
  EXPECT_NEAR(kept, 1, 0.02);
}

}  // namespace
}  // namespace freqsynth
