// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "freqsynth/image/reconstructor.h"
#include "support/image_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<float> random_pixels(std::size_t count, unsigned seed) {
  oracle::Random random(seed);
  std::vector<float> pixels(count);
  for (float& pixel : pixels) pixel = random.value();
  return pixels;
}

std::vector<std::pair<std::size_t, std::size_t>> sizes() {
  std::vector<std::pair<std::size_t, std::size_t>> all = {{1, 100}, {100, 1}, {33, 40}, {41, 23}};
  for (std::size_t width = 1; width <= 17; ++width) {
    for (std::size_t height = 1; height <= 17; ++height) all.push_back({width, height});
  }
  return all;
}

TEST(TransformPixels, ReconstructGivesThePixelsBack) {
  for (const auto& [width, height] : sizes()) {
    const auto pixels = random_pixels(width * height * 2, static_cast<unsigned>(width + height));
    const FrequencyImage image = transform_pixels(pixels, width, height, 2);
    EXPECT_EQ(image.meaning(), CoefficientMeaning::pixel_average);
    const std::vector<float> back = reconstruct(image);
    ASSERT_EQ(back.size(), pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      // Of 64 amplitudes, the magnitudes of which add up to about 5. Measured: 7 roundings of 1.
      ASSERT_NEAR(back[i], pixels[i], 9 * oracle::float_rounding) << width << " x " << height;
      const std::size_t x = i / 2 % width, y = i / 2 / width;
      ASSERT_NEAR(helpers::pixel_mean(image, x, y, i % 2), double{pixels[i]},
                  9 * oracle::float_rounding);
    }
  }
}

TEST(TransformPixels, WholeBlocksAreThoseOfTheForwardTransform) {
  const auto pixels = random_pixels(19 * 21, 3);
  const FrequencyImage image = transform_pixels(pixels, 19, 21, 1);
  for (std::size_t b = 0; b < 4; ++b) {
    std::array<float, max_terms> block, expected;
    for (std::size_t i = 0; i < 64; ++i) {
      block[i] = pixels[(b / 2 * 8 + i / 8) * 19 + b % 2 * 8 + i % 8];
    }
    forward_dct(block, expected);
    EXPECT_THAT(image.coefficients(b % 2, b / 2, 0), testing::ElementsAreArray(expected));
  }
}

TEST(TransformPixels, ANarrowBlockHasAsManyFrequenciesAsPixels) {
  for (std::size_t width = 1; width <= 8; ++width) {
    for (std::size_t height = 1; height <= 8; ++height) {
      const auto pixels = random_pixels(width * height, 5);
      const FrequencyImage image = transform_pixels(pixels, width, height, 1);
      for (std::size_t i = 0; i < max_terms; ++i) {
        const Frequency f = frequency_of_term(i);
        const bool has = f.u < width && f.v < height;
        EXPECT_EQ(image.coefficients(0, 0, 0)[i] != 0, has) << width << " x " << height;
      }
    }
  }
}

TEST(TransformPixels, RefusesTheWrongNumberOfValuesAndTakesNone) {
  const std::vector<float> pixels(5);
  EXPECT_THAT([&] { (void)transform_pixels(pixels, 2, 3, 1); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("5 values for 2 x 3 pixels of 1")));
  EXPECT_THROW((void)transform_pixels({}, 2, 3, 0), std::invalid_argument);
  EXPECT_EQ(transform_pixels({}, 0, 3, 2).blocks_x(), 0u);
}

}  // namespace
}  // namespace freqsynth
