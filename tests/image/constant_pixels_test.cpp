// SPDX-License-Identifier: MIT
#include "freqsynth/image/constant_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/tree_pictures.h"

namespace freqsynth {
namespace {

PriorBank small_bank() {
  PriorBank bank;
  bank.add(Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003));
  return bank;
}

struct Case {
  std::size_t width, height;
  double samples;  // per pixel
  std::uint64_t seed;
};

/// A value for each pixel, one of four. Just on borders of pixels there are others.
float in_pixels(double x, double y, std::uint64_t seed) {
  const auto column = static_cast<std::uint64_t>(x), row = static_cast<std::uint64_t>(y);
  if (x == std::floor(x) || y == std::floor(y)) return -3;
  const std::uint64_t bits = detail::mix_bits(seed + detail::golden_step * (column + 512 * row));
  return static_cast<float>(bits % 4) / 4;
}

class ConstantPixels : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Members, ConstantPixels,
                         testing::Values(Case{24, 24, 2, 1}, Case{32, 16, 4, 2}, Case{19, 21, 6, 3},
                                         Case{16, 16, 16, 4}, Case{40, 8, 3, 5}));

TEST_P(ConstantPixels, AreWhatTheirSamplesSay) {
  const Case& one = GetParam();
  const std::size_t pixels = one.width * one.height;
  TreeSettings settings;
  settings.width = one.width;
  settings.height = one.height;
  settings.weights = {1};
  settings.seed = one.seed;
  TreeSampler sampler(settings);
  std::vector<int> seen(pixels);
  sampler.run(
      [&](double x, double y) {
        if (x != std::floor(x) && y != std::floor(y)) {
          seen[static_cast<std::size_t>(y) * one.width + static_cast<std::size_t>(x)] += 1;
        }
        return in_pixels(x, y, one.seed);
      },
      static_cast<std::uint64_t>(one.samples * static_cast<double>(pixels)));
  TreePictures pictures(sampler.tree().positions(), small_bank());
  const std::vector<float> picture = pictures.pixels(sampler.tree());
  const std::vector<float> errors = pictures.errors(sampler.tree());
  std::size_t known = 0, exact = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    const double x = static_cast<double>(p % one.width) + 0.5;
    const double y = static_cast<double>(p / one.width) + 0.5;
    EXPECT_GE(picture[p], 0) << p;
    EXPECT_LE(picture[p], 0.75f) << p;
    exact += picture[p] == in_pixels(x, y, one.seed) ? 1 : 0;
    // Pixels that are split forget one.
    if (seen[p] < 2) continue;
    ++known;
    EXPECT_EQ(picture[p], in_pixels(x, y, one.seed)) << p;
    // 0.75 is the whole range, and 16 pixels are the fewest that may be judged by.
    EXPECT_LE(errors[p], 0.375f * 0.375f / 17) << p;
  }
  EXPECT_GT(known, pixels / 4);
  EXPECT_GT(exact, pixels * 3 / 4);
  ThreadPool pool(3);
  EXPECT_EQ(TreePictures(sampler.tree().positions(), small_bank()).pixels(sampler.tree(), pool),
            picture);
}

TEST(ConstantPixelsOfTiles, AreExactHoweverFewSamplesThereAre) {
  const auto tiles = [](double x, double y) {
    const int column = static_cast<int>(x / 8), row = static_cast<int>(y / 8);
    return static_cast<float>((column + row) % 2);
  };
  for (const std::uint64_t samples : {8192u, 16384u}) {
    TreeSettings settings;
    settings.width = settings.height = 64;
    settings.weights = {1};
    TreeSampler sampler(settings);
    sampler.run(tiles, samples);
    TreePictures pictures(sampler.tree().positions(), small_bank());
    const std::vector<float> picture = pictures.pixels(sampler.tree());
    for (std::size_t p = 0; p < picture.size(); ++p) {
      const double x = static_cast<double>(p % 64) + 0.5, y = static_cast<double>(p / 64) + 0.5;
      ASSERT_EQ(picture[p], tiles(x, y)) << p << " of " << samples;
    }
  }
}

TEST(ConstantPixelsOfSlopes, AreNone) {
  TreeSettings settings;
  settings.width = settings.height = 24;
  settings.weights = {1, 1};
  TreeSampler sampler(settings);
  // Of the second channel all pixels are constant, of the first none.
  sampler.run(
      [](double x, double y) {
        return std::array<float, 2>{static_cast<float>(x + 0.3 * y),
                                    in_pixels(std::floor(x) + 0.5, std::floor(y) + 0.5, 9)};
      },
      2000);
  SerialExecutor serial;
  const detail::ExecutorRef executor(serial);
  const detail::ConstantPixels constant(sampler.tree(), executor);
  std::vector<float> pixels(24 * 24 * 2, 7.0f), errors(24 * 24, 5.0f);
  constant.set_pixels(pixels, executor);
  constant.lower_errors(errors, executor);
  std::size_t set = 0;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    EXPECT_EQ(errors[p], 5);
    EXPECT_EQ(pixels[2 * p], 7);
    set += pixels[2 * p + 1] != 7 ? 1 : 0;
  }
  EXPECT_GT(set, errors.size() / 2);
}

}  // namespace
}  // namespace freqsynth
