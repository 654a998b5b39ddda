// SPDX-License-Identifier: MIT
#include "live/shown_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "freqsynth/jpeg/display_encoding.h"
#include "freqsynth/jpeg/jpeg.h"
#include "live/glue.h"

namespace live {
namespace {

/// An image whose blocks are even, of one light each.
freqsynth::FrequencyImage even_image(const std::vector<std::array<float, 3>>& lights) {
  freqsynth::FrequencyImage image(8 * lights.size(), 8, channels,
                                  freqsynth::CoefficientMeaning::pixel_average);
  for (std::size_t block = 0; block < lights.size(); ++block) {
    const auto sample = sample_of(lights[block]);
    for (std::size_t c = 0; c < channels; ++c) {
      image.coefficients(block, 0, c)[0] = 8 * sample[c];
    }
  }
  return image;
}

/// sRGB as its standard has it, of light that may be exposed beyond white.
double level(double light) {
  const double encoded =
      light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return 255 * std::min(encoded, 1.0);
}

TEST(ShownLight, IsThatOfTheDisplayAtAnyExposure) {
  std::vector<std::array<float, 3>> lights;
  for (float light = 0; light <= 4; light = light < 0.001f ? light + 0.0002f : light * 1.3f) {
    lights.push_back({light, light / 3, 0.7f * light});
  }
  const freqsynth::FrequencyImage image = even_image(lights);
  for (const double stops : {-4.0, -1.0, 0.0, 0.25, 2.0, 4.0}) {
    const freqsynth::FrequencyImage shown = exposed(image, stops);
    for (std::size_t block = 0; block < lights.size(); ++block) {
      std::array<float, 3> signal{};
      for (std::size_t c = 0; c < 3; ++c) signal[c] = shown.coefficients(block, 0, c)[0] / 8;
      const auto rgb = freqsynth::display_rgb(signal);
      for (std::size_t c = 0; c < 3; ++c) {
        const double light = std::exp2(stops) * double{lights[block][c]};
        const double seen = std::clamp(double{rgb[c]}, 0.0, 255.0);
        EXPECT_NEAR(seen, level(light), light < 0.0031308 ? 3 : 0.01) << light;
      }
    }
  }
}

TEST(ShownLight, HasALimitButLinearLightHasNone) {
  const auto sample = sample_of(std::array<float, 3>{100, 100, 100});
  EXPECT_EQ(sample[0], sample_of(std::array<float, 3>{most_shown, most_shown, most_shown})[0]);
  EXPECT_EQ(sample[3], 100);
  EXPECT_EQ(sample_of(std::array<float, 3>{-1, -1, -1})[0], 0);
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(sample_of(std::array<float, 3>{1, none, 1})[0]));
  EXPECT_EQ(linear_light(even_image({{1, 2, 30}})).coefficients(0, 0, 2)[0], 8 * 30);
}

TEST(ShownLight, BecomesAJpegFileOfTheSameLevels) {
  const std::vector<std::uint8_t> file =
      picture_jpeg(even_image({{0.5f, 0.5f, 0.5f}, {0, 0, 0}}), {.quality = 100});
  const freqsynth::QuantizedImage image = freqsynth::decode_jpeg(file);
  ASSERT_EQ(image.components.size(), 3u);
  const freqsynth::QuantizedComponent& luma = image.components[0];
  const double step = image.tables[luma.table][0];
  EXPECT_NEAR(128 + luma.values[0] * step / 8, level(0.5), step / 8);
  EXPECT_LE(128 + luma.values[64] * step / 8, step / 8);  // decoders clamp what is below black
}

}  // namespace
}  // namespace live
