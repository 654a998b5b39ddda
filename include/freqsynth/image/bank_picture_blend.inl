// SPDX-License-Identifier: MIT
// How BankPictures puts estimates of blocks together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/rounding.h"

namespace freqsynth {

/// What share a block has in the pixels that it and its margins cover, along one axis. Beside a
/// narrow block, and at the picture's border, nothing is blended.
FREQSYNTH_INLINE void BankPictures::Work::set_shares(std::size_t block, std::size_t count,
                                                     std::size_t pixels,
                                                     std::vector<float>& shares) const {
  const bool own = width_of(block, pixels) == block_size;
  const bool before = own && block > 0;
  const bool after = own && block + 1 < count && width_of(block + 1, pixels) == block_size;
  shares.assign(side, 0);
  for (std::size_t i = 0; i < side; ++i) {
    const double centre = static_cast<double>(i) + 0.5 - static_cast<double>(margin);
    shares[i] = detail::blend_share(centre, before ? margin : 0) *
                detail::blend_share(block_size - centre, after ? margin : 0);
  }
}

/// Adds a block of full size to its pixels and to those around.
FREQSYNTH_ROUNDING FREQSYNTH_INLINE void BankPictures::Work::blend(std::size_t x, std::size_t y) {
  FREQSYNTH_ROUNDING_BEGIN
  std::vector<float> across, down;
  set_shares(x, columns, picture.width, across);
  set_shares(y, rows, picture.height, down);
  const std::size_t block = (y - first_row) * columns + x;
  const float* own = averages.data() + block * channels * side * side;
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      if (across[i] == 0 || down[j] == 0) continue;
      const std::size_t px = x * block_size + i - margin, py = y * block_size + j - margin;
      const float weight = across[i] * down[j] / doubts[(block * side + j) * side + i];
      weights[py * picture.width + px] += weight;
      float* out = pixel(px, py);
      for (std::size_t c = 0; c < channels; ++c) {
        out[static_cast<std::ptrdiff_t>(c) * picture.channel_stride] +=
            weight * own[(c * side + j) * side + i];
      }
    }
  }
}

/// Writes the pixels of a narrow block, each of which covers several of the eight parts along an
/// axis; and the errors of any block.
FREQSYNTH_ROUNDING FREQSYNTH_INLINE void BankPictures::Work::fill(std::size_t x, std::size_t y,
                                                                  std::span<float> errors) {
  FREQSYNTH_ROUNDING_BEGIN
  const std::size_t width = width_of(x, picture.width), height = width_of(y, picture.height);
  const bool narrow = width < block_size || height < block_size;
  const std::size_t block = (y - first_row) * columns + x;
  const auto cover = [](std::size_t at, std::size_t count, std::size_t part) {
    const double scale = static_cast<double>(block_size) / static_cast<double>(count);
    const double low = std::max(static_cast<double>(at) * scale, static_cast<double>(part));
    const double high =
        std::min(static_cast<double>(at + 1) * scale, static_cast<double>(part + 1));
    return std::max(0.0, high - low) / scale;
  };
  const auto mean = [&](const float* numbers, std::size_t px, std::size_t py) {
    double sum = 0;
    for (std::size_t j = 0; j < block_size; ++j) {
      for (std::size_t i = 0; i < block_size; ++i) {
        sum += cover(px, width, i) * cover(py, height, j) *
               double{numbers[(j + margin) * side + i + margin]};
      }
    }
    return static_cast<float>(sum);
  };
  for (std::size_t py = 0; py < height; ++py) {
    for (std::size_t px = 0; px < width; ++px) {
      const std::size_t column = x * block_size + px, row = y * block_size + py;
      const float* error = squared_errors.data() + block * side * side;
      if (!errors.empty()) {
        errors[row * picture.width + column] =
            narrow ? mean(error, px, py) : error[(py + margin) * side + px + margin];
      }
      for (std::size_t c = 0; narrow && c < channels; ++c) {
        const float* own = averages.data() + (block * channels + c) * side * side;
        pixel(column, row)[static_cast<std::ptrdiff_t>(c) * picture.channel_stride] =
            mean(own, px, py);
        weights[row * picture.width + column] = 1;
      }
    }
  }
}

FREQSYNTH_INLINE void BankPictures::Work::divide() {
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const float weight = weights[y * picture.width + x];
      for (std::size_t c = 0; c < channels; ++c) {
        pixel(x, y)[static_cast<std::ptrdiff_t>(c) * picture.channel_stride] /= weight;
      }
    }
  }
}

}  // namespace freqsynth
