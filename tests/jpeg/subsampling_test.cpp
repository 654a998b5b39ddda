// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "freqsynth/jpeg/quantization.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using oracle::Real;
using test::random_signal;
using test::uniform_table;

/// The coefficients of the means of 2 x 2 pixels of four blocks, by way of the pixels.
std::array<Real, max_terms> halve_pixels(const std::array<std::array<float, max_terms>, 4>& four) {
  std::array<std::array<Real, 8>, 8> means{};
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 16; ++x) {
      means[y / 2][x / 2] += test::pixel_of_block(four[y / 8 * 2 + x / 8], x % 8, y % 8) / 4;
    }
  }
  return test::forward(means);
}

/// A sum of 256 products: four blocks, each along two axes. Along one axis the 16 weights of an
/// output have a sum of squares of at most 1 / 2 and thus a sum of at most sqrt(8), and the
/// roundings of the products even out. Measured: 2.1 roundings of the largest.
constexpr double halving_tolerance(double largest) {
  return largest * 2.65 * oracle::float_rounding;
}

TEST(HalveBlocks, IsTheMeanOfPixels) {
  oracle::Random random(7);
  for (int i = 0; i < 20; ++i) {
    const std::array four = {random.values<64>(), random.values<64>(), random.values<64>(),
                             random.values<64>()};
    const auto halved = halve_blocks(four);
    const auto expected = halve_pixels(four);
    for (std::size_t k = 0; k < max_terms; ++k) {
      EXPECT_NEAR(halved[k], static_cast<double>(expected[k]), halving_tolerance(1));
    }
  }
}

TEST(Quantize, HalvesTheResolutionOfChromaAtAnySize) {
  for (const auto& [width, height] :
       {std::pair<std::size_t, std::size_t>{1, 1}, {8, 8}, {9, 16}, {17, 9}, {40, 24}, {33, 64}}) {
    const FrequencyImage image = random_signal(width, height, 3, CoefficientMeaning::pixel_average);
    QuantizationSettings settings;
    settings.luminance = settings.chrominance = uniform_table(1);
    const QuantizedImage full = quantize(image, settings);
    settings.subsampling = Subsampling::both;
    const QuantizedImage quantized = quantize(image, settings);
    EXPECT_EQ(quantized.components[0].values, full.components[0].values);
    EXPECT_EQ(quantized.components[0].horizontal, 2);
    EXPECT_EQ(quantized.components[0].vertical, 2);
    for (std::size_t c = 1; c < 3; ++c) {
      const QuantizedComponent& component = quantized.components[c];
      EXPECT_EQ(component.horizontal, 1);
      EXPECT_EQ(component.vertical, 1);
      ASSERT_EQ(component.blocks_x, (width + 15) / 16);
      ASSERT_EQ(component.blocks_y, (height + 15) / 16);
      // Beyond the image the pixels of its last blocks come again, in opposite order.
      const auto mirrored = [](std::size_t at, std::size_t size) {
        const std::size_t begin = (size - 1) / 8 * 8;
        const std::size_t whole = begin + 8;
        if (at >= whole) at = 2 * whole - 1 - at;
        return at < begin ? at : begin + test::mirrored(at - begin, size - begin);
      };
      for (std::size_t b = 0; b < component.blocks_x * component.blocks_y; ++b) {
        std::array<std::array<Real, 8>, 8> means{};
        for (std::size_t y = 0; y < 16; ++y) {
          for (std::size_t x = 0; x < 16; ++x) {
            means[y / 2][x / 2] += static_cast<Real>(helpers::pixel_mean(
                                       image, mirrored(16 * (b % component.blocks_x) + x, width),
                                       mirrored(16 * (b / component.blocks_x) + y, height), c)) /
                                   4;
          }
        }
        const auto expected = test::forward(means);
        for (std::size_t i = 0; i < max_terms; ++i) {
          const auto kept = static_cast<double>(component.values[b * max_terms + i]);
          EXPECT_NEAR(kept, static_cast<double>(expected[i]), 0.5 + halving_tolerance(120));
        }
      }
    }
  }
}

TEST(Quantize, GrayHasNoChromaToHalve) {
  const FrequencyImage image = random_signal(17, 9, 1, CoefficientMeaning::pixel_average);
  QuantizationSettings settings;
  settings.subsampling = Subsampling::both;
  const QuantizedImage quantized = quantize(image, settings);
  ASSERT_EQ(quantized.components.size(), 1u);
  EXPECT_EQ(quantized.tables.size(), 1u);
  EXPECT_EQ(quantized.components[0].horizontal, 1);
  EXPECT_EQ(quantized.components[0].vertical, 1);
  quantized.validate();
}

}  // namespace
}  // namespace freqsynth
