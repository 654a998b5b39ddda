// SPDX-License-Identifier: MIT
/// \file
/// What several tests of quantisation share.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "freqsynth/image/frequency_image.h"
#include "freqsynth/jpeg/quantization.h"
#include "support/image_helpers.h"
#include "support/oracles.h"

namespace freqsynth::test {

using oracle::Real;

/// Coefficients that fall off, around the signal of a JPEG file: pixels stay in its range.
inline FrequencyImage random_signal(std::size_t width, std::size_t height, std::size_t channels,
                                    CoefficientMeaning meaning) {
  FrequencyImage image = helpers::random_image(width, height, channels, meaning, 120, 1);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) image.coefficients(x, y, 0)[0] += 1024;
  }
  return image;
}

inline QuantizationTable uniform_table(std::uint16_t step) {
  QuantizationTable table;
  table.fill(step);
  return table;
}

inline QuantizationTable random_table(unsigned seed, std::size_t largest) {
  oracle::Random random(seed);
  QuantizationTable table;
  for (auto& step : table) step = static_cast<std::uint16_t>(1 + random.below(largest));
  return table;
}

/// A consistent image with values of the whole range that JPEG codes.
/// \param horizontal, vertical  sampling factors of the first component; those of the others are 1
inline QuantizedImage random_quantized(std::size_t width, std::size_t height, std::size_t channels,
                                       int horizontal, int vertical) {
  oracle::Random random(static_cast<unsigned>(width + 1000 * height + channels));
  QuantizedImage image;
  image.width = width;
  image.height = height;
  image.tables.push_back(random_table(1, 255));
  if (channels > 1) image.tables.push_back(random_table(2, 255));
  for (std::size_t c = 0; c < channels; ++c) {
    QuantizedComponent& component = image.components.emplace_back();
    component.horizontal = c == 0 ? horizontal : 1;
    component.vertical = c == 0 ? vertical : 1;
    component.table = c == 0 ? 0 : 1;
    const auto blocks = [](std::size_t pixels, int factor, int largest) {
      return static_cast<std::size_t>(
          std::ceil(static_cast<double>(pixels) * factor / (8.0 * largest)));
    };
    component.blocks_x = blocks(width, component.horizontal, horizontal);
    component.blocks_y = blocks(height, component.vertical, vertical);
    component.values.resize(component.blocks_x * component.blocks_y * max_terms);
    for (std::size_t i = 0; i < component.values.size(); ++i) {
      // Mostly zeros, as in real files, some extremes.
      const std::size_t kind = random.below(8);
      int value = static_cast<int>(random.below(9)) - 4;
      if (kind < 4) value = 0;
      if (kind == 7) value = static_cast<int>(random.below(2047)) - 1023;
      if (i % max_terms == 0 && kind == 5) value = i % (2 * max_terms) == 0 ? -1024 : 1023;
      component.values[i] = static_cast<std::int16_t>(value);
    }
  }
  return image;
}

/// Eq. 2 at pixel (x, y) of a block.
inline Real pixel_of_block(const std::array<float, max_terms>& block, std::size_t x,
                           std::size_t y) {
  return oracle::block_value(block, (static_cast<Real>(x) + Real{0.5}) / 8,
                             (static_cast<Real>(y) + Real{0.5}) / 8);
}

/// The pixel of an axis of `size` that stands for pixel `at`, which may lie beyond: all are
/// repeated in opposite order, and so on.
inline std::size_t mirrored(std::size_t at, std::size_t size) {
  at %= 2 * size;
  return at < size ? at : 2 * size - 1 - at;
}

/// Eq. 1.
inline std::array<Real, max_terms> forward(const std::array<std::array<Real, 8>, 8>& pixels) {
  std::array<Real, max_terms> coefficients{};
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 0; x < 8; ++x) {
      const auto values = oracle::term_values((static_cast<Real>(x) + Real{0.5}) / 8,
                                              (static_cast<Real>(y) + Real{0.5}) / 8);
      for (std::size_t i = 0; i < max_terms; ++i) {
        coefficients[i] += oracle::amplitude(i) * pixels[y][x] * values[i];
      }
    }
  }
  return coefficients;
}

}  // namespace freqsynth::test
