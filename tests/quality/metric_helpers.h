// SPDX-License-Identifier: MIT
/// \file
/// Pictures for the tests of the metrics.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "quality/metrics.h"

namespace metric_helpers {

struct Picture {
  std::size_t width, height;
  std::vector<float> pixels;

  Picture(std::size_t w, std::size_t h, float value = 0)
      : width(w), height(h), pixels(3 * w * h, value) {}
  operator quality::PictureView() const { return {width, height, pixels}; }
  void set(std::size_t x, std::size_t y, float value) {
    for (std::size_t c = 0; c < 3; ++c) pixels[3 * (y * width + x) + c] = value;
  }
  /// A rectangle from (x, y).
  void fill(std::size_t x, std::size_t y, std::size_t w, std::size_t h, float value) {
    for (std::size_t i = 0; i < w * h; ++i) set(x + i % w, y + i / w, value);
  }
};

inline Picture noise(std::size_t width, std::size_t height, unsigned seed, float least = 0,
                     float most = 1) {
  Picture picture(width, height);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(least, most);
  for (float& value : picture.pixels) value = uniform(random);
  return picture;
}

inline std::vector<std::uint32_t> counts(const Picture& picture, std::uint32_t count) {
  return std::vector<std::uint32_t>(picture.width * picture.height, count);
}

/// Linear value whose display-encoded value is `encoded` of 255, above the linear part of sRGB.
inline float linear_of(double encoded) {
  return static_cast<float>(std::pow((encoded / 255 + 0.055) / 1.055, 2.4));
}

}  // namespace metric_helpers
