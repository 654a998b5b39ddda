// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/image/pixel_transform.h"

namespace freqsynth {
namespace detail {

/// From the means of the `length` pixels along an axis to the coefficients of the means of 8 equal
/// cells. The cosine transform of the pixels is divided by the mean of each cosine over a pixel and
/// multiplied by that over a cell.
struct PixelAxis {
  std::array<std::array<double, block_size>, block_size> weight{};  // [u][x]

  explicit PixelAxis(std::size_t length) {
    const auto pixels = static_cast<double>(length);
    for (std::size_t u = 0; u < length; ++u) {
      const auto frequency = static_cast<double>(u);
      const double scale = 4 * kappa(u) / pixels * sinc(frequency / (2.0 * block_size)) /
                           sinc(frequency / (2 * pixels));
      for (std::size_t x = 0; x < length; ++x) {
        const double middle = static_cast<double>(2 * x + 1) / (2 * pixels);
        weight[u][x] = scale * std::cos(std::numbers::pi * frequency * middle);
      }
    }
  }

  static const PixelAxis& of(std::size_t length) {
    static const std::array<PixelAxis, block_size> axes{PixelAxis(1), PixelAxis(2), PixelAxis(3),
                                                        PixelAxis(4), PixelAxis(5), PixelAxis(6),
                                                        PixelAxis(7), PixelAxis(8)};
    return axes[length - 1];
  }
};

FREQSYNTH_INLINE void transform_block(std::span<const float, max_terms> pixels, std::size_t width,
                                      std::size_t height,
                                      std::span<float, max_terms> coefficients) {
  FREQSYNTH_ASSERT(width >= 1 && width <= block_size && height >= 1 && height <= block_size);
  if (width == block_size && height == block_size) {
    forward_dct(pixels, coefficients);
    return;
  }
  const PixelAxis& across = PixelAxis::of(width);
  const PixelAxis& down = PixelAxis::of(height);
  double rows[block_size][block_size] = {};  // [y][u]
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t u = 0; u < width; ++u) {
      for (std::size_t x = 0; x < width; ++x) {
        rows[y][u] += across.weight[u][x] * double{pixels[y * block_size + x]};
      }
    }
  }
  for (std::size_t i = 0; i < max_terms; ++i) {
    const Frequency f = frequency_of_term(i);
    double sum = 0;
    for (std::size_t y = 0; y < height; ++y) sum += rows[y][f.u] * down.weight[f.v][y];
    coefficients[i] = static_cast<float>(sum);
  }
}

}  // namespace detail

FREQSYNTH_INLINE FrequencyImage transform_pixels(std::span<const float> pixels, std::size_t width,
                                                 std::size_t height, std::size_t channels) {
  FrequencyImage image(width, height, channels, CoefficientMeaning::pixel_average);
  if (pixels.size() != width * height * channels) {
    detail::refuse("transform_pixels: " + std::to_string(pixels.size()) + " values for " +
                   std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
                   std::to_string(channels) + " channels");
  }
  std::array<float, max_terms> block{};
  for (std::size_t by = 0; by < image.blocks_y(); ++by) {
    const std::size_t rows = image.block_height(by);
    for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
      const std::size_t columns = image.block_width(bx);
      const float* const corner =
          pixels.data() + (by * block_size * width + bx * block_size) * channels;
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t y = 0; y < rows; ++y) {
          for (std::size_t x = 0; x < columns; ++x) {
            block[y * block_size + x] = corner[(y * width + x) * channels + c];
          }
        }
        detail::transform_block(block, columns, rows, image.coefficients(bx, by, c));
      }
    }
  }
  return image;
}

}  // namespace freqsynth
