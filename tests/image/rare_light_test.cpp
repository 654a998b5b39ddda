// SPDX-License-Identifier: MIT
// Light of rare samples is found, and none of it is lost.
#include "freqsynth/image/rare_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "freqsynth/image/noisy_picture.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

/// Pixels of 1, each with some samples that say so.
NoisyPicture flat_picture(std::size_t width, std::size_t height, float samples) {
  NoisyPicture picture{width, height, NoisyPicture::Plane(width * height, samples), {}, {}, {}, {}};
  picture.sums = {picture.weights};
  picture.pixels = {NoisyPicture::Plane(width * height, 1.0f)};
  picture.variances = {NoisyPicture::Plane(width * height / max_terms)};
  return picture;
}

/// One more sample in a pixel, whose light the pixel shows and its block's fit leaves over.
void add_sample(NoisyPicture& picture, std::size_t pixel, float value) {
  const auto block_of = [&](std::size_t i) {
    return i / picture.width / block_size * (picture.width / block_size) +
           i % picture.width / block_size;
  };
  picture.weights[pixel] += 1;
  picture.sums[0][pixel] += value;
  picture.pixels[0][pixel] = picture.sums[0][pixel] / picture.weights[pixel];
  float samples = 0;
  for (std::size_t i = 0; i < picture.weights.size(); ++i) {
    if (block_of(i) == block_of(pixel)) samples += picture.weights[i];
  }
  picture.variances[0][block_of(pixel)] += value * value / samples;
}

/// Sum of values by the numbers of samples.
double by_samples(const NoisyPicture& picture, const NoisyPicture::Plane& pixels) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    sum += static_cast<double>(picture.weights[i]) * static_cast<double>(pixels[i]);
  }
  return sum;
}

double sum_of(const NoisyPicture::Plane& plane) {
  double sum = 0;
  for (const float value : plane) sum += static_cast<double>(value);
  return sum;
}

TEST(RareLight, NothingOfItIsLost) {
  oracle::Random random(31);
  for (int run = 0; run < 40; ++run) {
    const std::size_t width = 8 * (3 + random.below(18)), height = 8 * (3 + random.below(18));
    NoisyPicture picture = flat_picture(width, height, 1);
    for (std::size_t i = 0; i < picture.weights.size(); ++i) {
      // Some blocks have many samples, some pixels have none.
      const double samples = i % width / 8 % 3 == 0 ? random.uniform(0, 40) : random.uniform(0, 1);
      picture.weights[i] = samples < 0.3 ? 0.0f : static_cast<float>(samples);
      picture.pixels[0][i] = static_cast<float>(random.uniform(run % 4 == 0 ? -1 : 0, 2));
      picture.sums[0][i] = picture.weights[i] * picture.pixels[0][i];
    }
    for (std::size_t event = 0; event < 1 + width * height / 4096; ++event) {
      add_sample(picture, random.below(width * height), 1000);
    }
    const detail::RareLight light(picture, 0);
    const double taken = sum_of(picture.sums[0]) - sum_of(light.other_sums());
    ASSERT_GT(taken, 900) << width << " x " << height;
    NoisyPicture::Plane pixels = picture.pixels[0];
    light.spread(pixels);
    EXPECT_NEAR(by_samples(picture, pixels) - by_samples(picture, picture.pixels[0]), taken,
                1e-4 * taken)
        << width << " x " << height;
    for (std::size_t i = 0; i < pixels.size(); ++i) ASSERT_GE(pixels[i], picture.pixels[0][i]);
  }
}

TEST(RareLight, IsWhatASampleHasTooMuch) {
  NoisyPicture picture = flat_picture(64, 64, 2);
  for (float& sum : picture.sums[0]) sum = 2;
  const NoisyPicture::Plane without = picture.sums[0];
  for (const std::size_t pixel : {0u, 64u * 20 + 20, 64u * 63 + 63})
    add_sample(picture, pixel, 100);
  const NoisyPicture::Plane others = detail::RareLight(picture, 0).other_sums();
  for (std::size_t i = 0; i < others.size(); ++i) {
    ASSERT_NEAR(others[i], picture.weights[i] * picture.pixels[0][1], 1e-4) << i;
  }
  EXPECT_EQ(without[1], others[1]);
}

TEST(RareLight, SpotsAndCommonNoiseAreNone) {
  NoisyPicture picture = flat_picture(64, 64, 1);
  for (std::size_t y = 20; y < 25; ++y) {
    for (std::size_t x = 20; x < 25; ++x) add_sample(picture, 64 * y + x, 100);
  }
  EXPECT_EQ(detail::RareLight(picture, 0).other_sums(), picture.sums[0]);

  oracle::Random random(32);
  picture = flat_picture(64, 64, 1);
  for (std::size_t i = 0; i < picture.weights.size(); ++i) {
    picture.pixels[0][i] = static_cast<float>(random.uniform(0, 2));
    picture.sums[0][i] = picture.pixels[0][i];
  }
  std::fill(picture.variances[0].begin(), picture.variances[0].end(), 1.0f / 3);
  EXPECT_EQ(detail::RareLight(picture, 0).other_sums(), picture.sums[0]);
}

TEST(RareLight, WhatIsBlackStaysSo) {
  NoisyPicture picture = flat_picture(64, 64, 1);
  for (std::size_t i = 0; i < picture.weights.size(); ++i) {
    if (i % 64 >= 40) picture.sums[0][i] = picture.pixels[0][i] = 0;
  }
  for (std::size_t y = 4; y < 64; y += 8) add_sample(picture, 64 * y + 20, 40);
  const detail::RareLight light(picture, 0);
  NoisyPicture::Plane pixels = picture.pixels[0];
  light.spread(pixels);
  const float lit = pixels[64 * 33 + 30] - 1, black = pixels[64 * 33 + 45];
  EXPECT_GT(lit, 0.05f);
  EXPECT_LT(black, 0.05f * lit);
}

}  // namespace
}  // namespace freqsynth
