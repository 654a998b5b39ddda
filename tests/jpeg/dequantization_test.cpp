// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/dequantization.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/quantization.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using oracle::Real;
using test::random_quantized;
using test::random_signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Dequantize, IsWithinHalfAStepOfWhatWasQuantised) {
  for (const std::size_t channels : {std::size_t{1}, std::size_t{3}}) {
    const FrequencyImage image = random_signal(41, 23, channels, CoefficientMeaning::pixel_average);
    const QuantizedImage quantized = quantize(image);
    const FrequencyImage back = dequantize(quantized);
    EXPECT_EQ(back.width(), 41u);
    EXPECT_EQ(back.height(), 23u);
    EXPECT_EQ(back.channels(), channels);
    EXPECT_EQ(back.meaning(), CoefficientMeaning::pixel_average);
    const QuantizedImage again = quantize(back);
    // Of whole blocks, that is; narrow_blocks_test.cpp has the others.
    for (std::size_t b = 0; b < 5 * 2; ++b) {
      const std::size_t x = b % 5, y = b / 5;
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < max_terms; ++i) {
          const double step = quantized.tables[c == 0 ? 0 : 1][i];
          // The level shift rounds numbers of about 1024.
          EXPECT_NEAR(back.coefficients(x, y, c)[i], image.coefficients(x, y, c)[i],
                      0.5 * step + 4 * 1200 * oracle::float_rounding);
          // What has been quantised once stays.
          const std::size_t place = (y * 6 + x) * max_terms + i;
          EXPECT_EQ(again.components[c].values[place], quantized.components[c].values[place]);
        }
      }
    }
  }
}

/// Pixel (x, y) of a component by eq. 2 and its table.
Real component_pixel(const QuantizedImage& image, std::size_t channel, std::size_t x,
                     std::size_t y) {
  const QuantizedComponent& component = image.components[channel];
  std::array<float, max_terms> block;
  for (std::size_t i = 0; i < max_terms; ++i) {
    block[i] =
        static_cast<float>(component.values[(y / 8 * component.blocks_x + x / 8) * max_terms + i] *
                           image.tables[component.table][i]);
  }
  return test::pixel_of_block(block, x % 8, y % 8) + (channel == 0 ? 128 : 0);
}

TEST(Dequantize, ReplicatesThePixelsOfSubsampledComponents) {
  for (const auto& [horizontal, vertical] :
       {std::pair{1, 1}, {2, 2}, {2, 1}, {1, 2}, {4, 1}, {1, 4}, {4, 2}, {3, 1}}) {
    for (const auto& [width, height] :
         {std::pair<std::size_t, std::size_t>{1, 1}, {19, 13}, {40, 33}}) {
      const QuantizedImage image = random_quantized(width, height, 3, horizontal, vertical);
      const std::vector<float> pixels = reconstruct(dequantize(image));
      for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
          for (std::size_t c = 0; c < 3; ++c) {
            const auto across = static_cast<std::size_t>(c == 0 ? 1 : horizontal);
            const auto down = static_cast<std::size_t>(c == 0 ? 1 : vertical);
            const auto expected =
                static_cast<double>(component_pixel(image, c, x / across, y / down));
            // Coefficients reach 1023 * 255. Measured: 1.9 roundings of that.
            ASSERT_NEAR(pixels[(y * width + x) * 3 + c], expected,
                        1023 * 255 * 2.4 * oracle::float_rounding)
                << horizontal << vertical;
          }
        }
      }
    }
  }
}

TEST(Dequantize, OfHalvedChromaKeepsTheMeansOfPixels) {
  const FrequencyImage image = random_signal(48, 32, 3, CoefficientMeaning::pixel_average);
  QuantizationSettings settings;
  settings.luminance = settings.chrominance = test::uniform_table(1);
  settings.subsampling = Subsampling::both;
  const std::vector<float> before = reconstruct(image);
  const std::vector<float> after = reconstruct(dequantize(quantize(image, settings)));
  double squares = 0;
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 48; ++x) {
      const auto at = [&](const std::vector<float>& pixels, std::size_t i, std::size_t j) {
        return double{pixels[(j * 48 + i) * 3 + 1]};
      };
      const std::size_t i = x / 2 * 2, j = y / 2 * 2;
      const double mean = (at(before, i, j) + at(before, i + 1, j) + at(before, i, j + 1) +
                           at(before, i + 1, j + 1)) /
                          4;
      squares += std::pow(at(after, x, y) - mean, 2);
    }
  }
  // An orthonormal transform: the root of the mean square of the pixels' errors is that of the
  // coefficients', 0.29 where they are even in half a step.
  EXPECT_LE(std::sqrt(squares / (48 * 32)), 0.352);
}

TEST(Dequantize, RefusesFactorsThatDoNotDivide) {
  QuantizedImage image = random_quantized(24, 24, 3, 3, 1);
  image.components[1].horizontal = 2;
  image.components[1].blocks_x = 2;
  image.components[1].values.resize(2 * 3 * max_terms);
  image.validate();
  EXPECT_THAT([&] { (void)dequantize(image); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("2 x 1 do not divide")));
}

TEST(QuantizedImage, FaultsAreNamed) {
  using Change = std::function<void(QuantizedImage&)>;
  const std::vector<std::pair<const char*, Change>> faults = {
      {"0 x 19 pixels", [](QuantizedImage& q) { q.width = 0; }},
      {"33 x 0 pixels", [](QuantizedImage& q) { q.height = 0; }},
      {"no component", [](QuantizedImage& q) { q.components.clear(); }},
      {"table 1 holds a 0", [](QuantizedImage& q) { q.tables[1][5] = 0; }},
      {"component 2 has sampling factors 0 x 1", [](auto& q) { q.components[2].horizontal = 0; }},
      {"component 0 has sampling factors 2 x 5", [](auto& q) { q.components[0].vertical = 5; }},
      {"component 1 names table 2 of 2", [](auto& q) { q.components[1].table = 2; }},
      {"component 0 has 4 x 3 blocks, not 5 x 3", [](auto& q) { q.components[0].blocks_x = 4; }},
      {"component 1 has 3 x 9 blocks, not 3 x 2", [](auto& q) { q.components[1].blocks_y = 9; }},
      {"component 2 has 383 values for 3 x 2", [](auto& q) { q.components[2].values.pop_back(); }},
      {"component 2 has 0 values for 3 x 2", [](auto& q) { q.components[2].values.clear(); }},
  };
  const QuantizedImage good = random_quantized(33, 19, 3, 2, 2);
  good.validate();
  for (const auto& [message, change] : faults) {
    QuantizedImage image = good;
    change(image);
    const auto refused = ThrowsMessage<std::invalid_argument>(HasSubstr(message));
    EXPECT_THAT([&] { image.validate(); }, refused);
    EXPECT_THAT([&] { (void)dequantize(image); }, refused);
  }
}

}  // namespace
}  // namespace freqsynth
