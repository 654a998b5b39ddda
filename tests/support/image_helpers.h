// SPDX-License-Identifier: MIT
/// \file
/// Frequency images to test with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "freqsynth/image/frequency_image.h"
#include "support/oracles.h"

namespace helpers {

/// Random sample counts, and random coefficients: that of term i is below scale / (1 + falloff i).
inline freqsynth::FrequencyImage random_image(std::size_t width, std::size_t height,
                                              std::size_t channels,
                                              freqsynth::CoefficientMeaning meaning, float scale,
                                              float falloff) {
  oracle::Random random(static_cast<unsigned>(31 * width + height));
  freqsynth::FrequencyImage image(width, height, channels, meaning);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      image.samples(x, y) = static_cast<std::uint32_t>(1 + random.below(200));
      for (std::size_t c = 0; c < channels; ++c) {
        const auto out = image.coefficients(x, y, c);
        for (std::size_t i = 0; i < freqsynth::max_terms; ++i) {
          out[i] = scale * random.value() / (1 + falloff * static_cast<float>(i));
        }
      }
    }
  }
  return image;
}

/// Mean over pixel (x, y) of an image of finished pixels: each term, a cosine over the block's own
/// length, whose coefficient tells of the mean over an eighth of that.
inline double pixel_mean(const freqsynth::FrequencyImage& image, std::size_t x, std::size_t y,
                         std::size_t channel) {
  using oracle::Real;
  const auto term_mean = [](std::size_t place, std::size_t size, int frequency) {
    const std::size_t begin = place / 8 * 8;
    const auto length = static_cast<Real>(std::min(begin + 8, size) - begin);
    const auto mean = [&](Real from, Real to) {
      const Real omega = oracle::pi * frequency;
      return frequency == 0
                 ? 1
                 : (std::sin(omega * to) - std::sin(omega * from)) / (omega * (to - from));
    };
    const Real at = static_cast<Real>(place - begin) / length;
    const Real cell =
        frequency == 0 ? 1 : std::sin(oracle::pi * frequency / 16) / (oracle::pi * frequency / 16);
    return mean(at, at + 1 / length) / cell;
  };
  const auto coefficients = image.coefficients(x / 8, y / 8, channel);
  Real sum = 0;
  for (std::size_t i = 0; i < freqsynth::max_terms; ++i) {
    sum += oracle::amplitude(i) * static_cast<Real>(coefficients[i]) *
           term_mean(x, image.width(), oracle::horizontal(i)) *
           term_mean(y, image.height(), oracle::vertical(i));
  }
  return static_cast<double>(sum);
}

}  // namespace helpers
