// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/srgb.h"
#include "freqsynth/image/pixel_transform.h"
#include "freqsynth/jpeg/display_encoding.h"

namespace freqsynth {
namespace detail {

/// `value`, or not a number. Chosen as bits, for where compilers may take all values for numbers
/// they may drop a choice between floats.
inline float value_or_nan(bool good, float value) {
  constexpr std::uint32_t nan = 0x7fc00000u;
  return std::bit_cast<float>(good ? std::bit_cast<std::uint32_t>(value) : nan);
}

inline float clamp_to_one(float x) { return std::fmin(std::fmax(x, 0.0f), 1.0f); }

}  // namespace detail

FREQSYNTH_INLINE void DisplayEncoding::validate() const {
  detail::require(detail::is_finite(exposure) && exposure > 0, "exposure", exposure,
                  "a finite number > 0");
}

FREQSYNTH_INLINE float DisplayEncoding::encode(float linear) const {
  const float encoded = 255 * detail::srgb_of_linear(detail::clamp_to_one(linear * exposure));
  return detail::value_or_nan(detail::is_finite(linear), encoded);
}

FREQSYNTH_INLINE float DisplayEncoding::decode(float encoded) const {
  const float linear = detail::linear_of_srgb(detail::clamp_to_one(encoded / 255)) / exposure;
  return detail::value_or_nan(!detail::is_nan(encoded), linear);
}

FREQSYNTH_INLINE std::array<float, 3> DisplayEncoding::encode(
    const std::array<float, 3>& rgb) const {
  const float r = encode(rgb[0]);
  const float g = encode(rgb[1]);
  const float b = encode(rgb[2]);
  const float y = 0.299f * r + 0.587f * g + 0.114f * b;
  return {y, (b - y) / 1.772f, (r - y) / 1.402f};
}

FREQSYNTH_INLINE void DisplayEncoding::encode(std::span<float> values, std::size_t channels) const {
  for (std::size_t first = 0; first + channels <= values.size(); first += channels) {
    const std::span<float> pixel = values.subspan(first, channels);
    bool good = true;
    for (const float& value : pixel) good = good && detail::is_finite(value);
    if (!good) {
      for (float& value : pixel) value = detail::value_or_nan(false, 0);
    } else if (channels == 3) {
      const auto ycc = encode(std::array{pixel[0], pixel[1], pixel[2]});
      std::copy(ycc.begin(), ycc.end(), pixel.begin());
    } else {
      for (float& value : pixel) value = encode(value);
    }
  }
}

FREQSYNTH_INLINE std::array<float, 3> display_rgb(const std::array<float, 3>& ycc) {
  const float r = ycc[0] + 1.402f * ycc[2];
  const float b = ycc[0] + 1.772f * ycc[1];
  const float g = (ycc[0] - 0.299f * r - 0.114f * b) / 0.587f;
  return {r, g, b};
}

FREQSYNTH_INLINE void detail::check_display_channels(std::size_t channels,
                                                     std::size_t sampler_channels) {
  if (channels != 1 && channels != 3) {
    refuse("display encoding of " + std::to_string(channels) + " channels, not 1 or 3");
  }
  if (sampler_channels != channels) {
    refuse("display encoding of " + std::to_string(channels) +
           " channels for a sampler that returns " + std::to_string(sampler_channels) + " values");
  }
}

FREQSYNTH_INLINE FrequencyImage encode_pixels(const FrequencyImage& linear,
                                              const DisplayEncoding& encoding,
                                              const ReconstructionSettings& settings) {
  const std::size_t channels = linear.channels();
  detail::check_display_channels(channels, channels);
  encoding.validate();
  std::vector<float> pixels = reconstruct(linear, settings);
  encoding.encode(pixels, channels);
  FrequencyImage encoded = transform_pixels(pixels, linear.width(), linear.height(), channels);
  for (std::size_t by = 0; by < encoded.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < encoded.blocks_x(); ++bx) {
      encoded.samples(bx, by) = linear.samples(bx, by);
    }
  }
  return encoded;
}

}  // namespace freqsynth
