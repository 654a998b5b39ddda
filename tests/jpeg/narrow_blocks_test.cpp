// SPDX-License-Identifier: MIT
// Images whose size is no multiple of 8: their last blocks are narrow, those of JPEG are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/dequantization.h"
#include "freqsynth/jpeg/quantization.h"
#include "support/image_helpers.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using oracle::Real;
using test::random_signal;

using Size = std::pair<std::size_t, std::size_t>;

std::vector<Size> sizes() {
  std::vector<Size> all = {{25, 9}, {33, 40}, {1, 50}, {50, 1}, {41, 23}};
  for (std::size_t width = 1; width <= 17; ++width) {
    for (std::size_t height = 1; height <= 17; ++height) all.push_back({width, height});
  }
  return all;
}

/// The block (x, y) of a component without the level shift.
std::array<float, max_terms> block_of(const QuantizedImage& image, std::size_t channel,
                                      std::size_t x, std::size_t y) {
  const QuantizedComponent& component = image.components[channel];
  std::array<float, max_terms> block;
  for (std::size_t i = 0; i < max_terms; ++i) {
    block[i] = static_cast<float>(component.values[(y * component.blocks_x + x) * max_terms + i] *
                                  image.tables[component.table][i]);
  }
  if (channel == 0) block[0] += 1024;
  return block;
}

TEST(NarrowBlocks, DequantizedPixelsAreThoseOfADecoder) {
  for (const auto& [width, height] : sizes()) {
    const QuantizedImage image = test::random_quantized(width, height, 1, 1, 1);
    const std::vector<float> pixels = reconstruct(dequantize(image));
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const auto expected = static_cast<double>(
            test::pixel_of_block(block_of(image, 0, x / 8, y / 8), x % 8, y % 8));
        // Coefficients reach 1023 * 255. Measured: 2.3 roundings of that.
        ASSERT_NEAR(pixels[y * width + x], expected, 1023 * 255 * 2.9 * oracle::float_rounding)
            << width << " x " << height;
      }
    }
  }
}

TEST(NarrowBlocks, AreExtendedAsInAMirror) {
  for (const auto& [width, height] : sizes()) {
    const FrequencyImage image = random_signal(width, height, 1, CoefficientMeaning::pixel_average);
    const QuantizedImage quantized = quantize(image, {.luminance = test::uniform_table(1)});
    const std::size_t bx = image.blocks_x() - 1, by = image.blocks_y() - 1;
    std::array<std::array<Real, 8>, 8> pixels;
    for (std::size_t y = 0; y < 8; ++y) {
      for (std::size_t x = 0; x < 8; ++x) {
        pixels[y][x] =
            static_cast<Real>(helpers::pixel_mean(image, 8 * bx + test::mirrored(x, width - 8 * bx),
                                                  8 * by + test::mirrored(y, height - 8 * by), 0));
      }
    }
    const auto expected = test::forward(pixels);
    const auto block = block_of(quantized, 0, bx, by);
    for (std::size_t i = 0; i < max_terms; ++i) {
      ASSERT_NEAR(block[i], static_cast<double>(expected[i]),
                  0.5 + 4 * 1200 * oracle::float_rounding)
          << width << " x " << height;
    }
  }
}

/// Both meanings, with the filter of a point function: the transform is orthonormal, so that no
/// more error reaches the pixels of a block than half a step in each coefficient.
TEST(NarrowBlocks, ReconstructAgreesWithTheFile) {
  for (const auto meaning :
       {CoefficientMeaning::pixel_average, CoefficientMeaning::point_function}) {
    for (const auto& [width, height] : sizes()) {
      const FrequencyImage image = random_signal(width, height, 3, meaning);
      const QuantizedImage quantized = quantize(image);
      const std::vector<float> before = reconstruct(image);
      const std::vector<float> after = reconstruct(dequantize(quantized));
      for (std::size_t c = 0; c < 3; ++c) {
        double most = 0;
        for (const auto step : quantized.tables[c == 0 ? 0 : 1]) most += 0.25 * step * step;
        for (std::size_t by = 0; by < image.blocks_y(); ++by) {
          for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
            double squares = 0;
            for (std::size_t y = 8 * by; y < std::min(8 * by + 8, height); ++y) {
              for (std::size_t x = 8 * bx; x < std::min(8 * bx + 8, width); ++x) {
                const std::size_t i = (y * width + x) * 3 + c;
                squares += std::pow(before[i] - after[i], 2);
              }
            }
            ASSERT_LE(squares, most) << width << " x " << height;
          }
        }
      }
    }
  }
}

TEST(NarrowBlocks, AConstantIsOneCoefficient) {
  for (const auto& [width, height] : sizes()) {
    FrequencyImage image(width, height, 1, CoefficientMeaning::pixel_average);
    for (std::size_t y = 0; y < image.blocks_y(); ++y) {
      for (std::size_t x = 0; x < image.blocks_x(); ++x) image.coefficients(x, y, 0)[0] = 8 * 190;
    }
    const QuantizedImage quantized = quantize(image, {.luminance = test::uniform_table(1)});
    for (std::size_t i = 0; i < quantized.components[0].values.size(); ++i) {
      ASSERT_EQ(quantized.components[0].values[i], i % max_terms == 0 ? 8 * (190 - 128) : 0);
    }
  }
}

}  // namespace
}  // namespace freqsynth
