// SPDX-License-Identifier: MIT
/// \file
/// Frequency images to test with.
#pragma once

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

}  // namespace helpers
