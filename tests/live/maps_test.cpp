// SPDX-License-Identifier: MIT
#include "live/maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "freqsynth/basis/dct.h"
#include "freqsynth/jpeg/jpeg.h"
#include "live/shown_light.h"

namespace live {
namespace {

TEST(Maps, JpegHasAPixelForEachBlock) {
  BlockMap map{19, 9, {}};
  for (int i = 0; i < 19 * 9; ++i) map.values.push_back(static_cast<float>(i));
  const freqsynth::QuantizedImage image = freqsynth::decode_jpeg(map_jpeg(map, 150));
  EXPECT_EQ(image.width, 19u);
  EXPECT_EQ(image.height, 9u);
  const freqsynth::QuantizedComponent& gray = image.components.at(0);
  for (std::size_t y = 0; y < 9; ++y) {
    for (std::size_t x = 0; x < 19; ++x) {
      const std::size_t block = y / 8 * gray.blocks_x + x / 8;
      std::array<float, 64> coefficients{}, pixels{};
      for (std::size_t i = 0; i < 64; ++i) {
        coefficients[i] = static_cast<float>(gray.values[64 * block + i] * image.tables[0][i]);
      }
      freqsynth::inverse_dct(coefficients, pixels);
      const double wanted = 255 * std::sqrt(std::min(static_cast<double>(19 * y + x) / 150, 1.0));
      EXPECT_NEAR(pixels[y % 8 * 8 + x % 8] + 128, wanted, 2) << x << ' ' << y;
    }
  }
}

TEST(Maps, SamplesAndErrorsAreThoseOfBlocks) {
  freqsynth::Synthesizer engine(settings_of(43, 21, false));
  engine.run(
      [](double x, double y) {
        const float light = x * x + y > 300 ? 1.0f : 0.1f;
        return sample_of(std::array<float, 3>{light, light / 2, 0});
      },
      {.samples_per_pixel = 1});
  const freqsynth::FrequencyImage image = engine.image();
  const BlockMap samples = samples_of(image), errors = errors_of(engine);
  ASSERT_EQ(samples.columns, 6u);
  ASSERT_EQ(samples.values.size(), 18u);
  ASSERT_EQ(errors.values.size(), 18u);
  const std::vector<float> pixels = engine.error_image();
  double square = 0;
  for (std::size_t by = 0; by < 3; ++by) {
    for (std::size_t bx = 0; bx < 6; ++bx) {
      EXPECT_EQ(samples.values[6 * by + bx], static_cast<float>(image.samples(bx, by)));
      double sum = 0;
      int count = 0;
      for (std::size_t y = 8 * by; y < std::min<std::size_t>(8 * by + 8, 21); ++y) {
        for (std::size_t x = 8 * bx; x < std::min<std::size_t>(8 * bx + 8, 43); ++x) {
          for (std::size_t c = 0; c < 3; ++c) {
            sum += std::pow(pixels[(y * 43 + x) * channels + c], 2);
            ++count;
          }
        }
      }
      EXPECT_NEAR(errors.values[6 * by + bx], std::sqrt(sum / count), 1e-3);
      square += sum;
    }
  }
  // The whole is what the engine says of it.
  EXPECT_NEAR(std::sqrt(square / (43 * 21 * 3)), engine.predicted_rmse(), 1e-3);
}

}  // namespace
}  // namespace live
