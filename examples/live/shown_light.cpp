// SPDX-License-Identifier: MIT
#include "shown_light.h"

#include <cmath>

namespace live {
namespace {

constexpr float curve = 1 / 2.4f;
constexpr float slope = 1.055f, offset = 0.055f;  // of sRGB

/// Of light that is not a number, not a number.
float power_of(float light) {
  const float limited = light > most_shown ? most_shown : light < 0 ? 0 : light;
  return 255 * slope * std::pow(limited, curve);
}

freqsynth::FrequencyImage scaled_channels(const freqsynth::FrequencyImage& image, std::size_t first,
                                          std::size_t count, float factor) {
  freqsynth::FrequencyImage part(image.width(), image.height(), count, image.meaning());
  for (std::size_t by = 0; by < image.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
      part.samples(bx, by) = image.samples(bx, by);
      for (std::size_t c = 0; c < count; ++c) {
        const auto from = image.coefficients(bx, by, first + c);
        const auto to = part.coefficients(bx, by, c);
        for (std::size_t i = 0; i < from.size(); ++i) to[i] = factor * from[i];
      }
    }
  }
  return part;
}

}  // namespace

std::array<float, channels> sample_of(std::span<const float, 3> rgb) {
  const float r = power_of(rgb[0]), g = power_of(rgb[1]), b = power_of(rgb[2]);
  // BT.601 over the full range, as JFIF has it.
  const float y = 0.299f * r + 0.587f * g + 0.114f * b;
  return {y, (b - y) / 1.772f, (r - y) / 1.402f, rgb[0], rgb[1], rgb[2]};
}

freqsynth::SynthesisSettings settings_of(std::size_t width, std::size_t height, bool noisy) {
  using enum freqsynth::ChannelRole;
  freqsynth::SynthesisSettings settings{.width = width, .height = height, .channels = channels};
  settings.noise = noisy ? freqsynth::Noise::present : freqsynth::Noise::none;
  settings.channel_settings.assign(shown_channels, {steer});
  settings.channel_settings.resize(channels, {passive});
  return settings;
}

float exposure_factor(double stops) { return static_cast<float>(std::exp2(stops / 2.4)); }

freqsynth::FrequencyImage exposed(const freqsynth::FrequencyImage& image, double stops) {
  freqsynth::FrequencyImage shown =
      scaled_channels(image, 0, shown_channels, exposure_factor(stops));
  for (std::size_t by = 0; by < shown.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < shown.blocks_x(); ++bx) {
      // The constant coefficient is 8 times the mean.
      shown.coefficients(bx, by, 0)[0] -= 8 * 255 * offset;
    }
  }
  return shown;
}

freqsynth::FrequencyImage linear_light(const freqsynth::FrequencyImage& image) {
  return scaled_channels(image, shown_channels, channels - shown_channels, 1);
}

}  // namespace live
