// SPDX-License-Identifier: MIT
// How benchmarks/field_cases measures.

#include "field_cases/measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "field_cases/members.h"
#include "field_cases/named_fields.h"

namespace {

using field_cases::Picture;

TEST(Measure, JitteredSamplesAreExactWhereEdgesLieOnPixelBorders) {
  const field_cases::Field field = field_cases::rectangle_and_line(0);
  const std::vector<double> right = right_pixels(field);
  for (const std::uint64_t rate : {1u, 4u, 16u}) {
    const Picture picture =
        field_cases::jittered(field_cases::sampler_of(field), 128, 96, 1, rate * 128 * 96, 3);
    EXPECT_LT(squared_error(picture, right), 1e-14);
  }
}

TEST(Measure, JitteredSamplesTakeWhatIsAllowed) {
  for (const std::uint64_t samples : {1u, 7u, 130u, 400u, 1000u}) {
    std::uint64_t calls = 0;
    const auto sampler = [&](double x, double y, std::uint64_t, std::span<float> values) {
      EXPECT_TRUE(x >= 0 && x <= 20 && y >= 0 && y <= 20);
      ++calls;
      values[0] = 0.25f;
    };
    const Picture picture = field_cases::jittered(sampler, 20, 20, 1, samples, 1);
    EXPECT_EQ(calls, samples);
    // No pixel is left without a value, not even those that no sample fell into.
    for (const float value : picture.pixels) EXPECT_EQ(value, 0.25f);
  }
}

TEST(Measure, JitteredSamplesLeaveOutWhatIsNoNumber) {
  const auto sampler = [](double x, double, std::uint64_t, std::span<float> values) {
    values[0] = x - std::floor(x) < 0.5 ? std::numeric_limits<float>::quiet_NaN() : 3.0f;
  };
  const Picture picture = field_cases::jittered(sampler, 16, 16, 1, 16 * 16 * 4, 1);
  for (const float value : picture.pixels) EXPECT_EQ(value, 3.0f);
}

TEST(Measure, ErrorsAreThoseOfTheColumnsAsked) {
  const Picture picture{3, 2, 1, {1, 2, 3, 1, 2, 5}, 0};
  const std::vector<double> right{1, 1, 1, 1, 1, 1};
  EXPECT_DOUBLE_EQ(squared_error(picture, right), (1 + 4 + 1 + 16) / 6.0);
  EXPECT_DOUBLE_EQ(squared_error(picture, right, {0, 2}), 2 / 4.0);
  EXPECT_DOUBLE_EQ(squared_error(picture, right, {2, 3}), 20 / 2.0);
  EXPECT_DOUBLE_EQ(mean(picture), 14 / 6.0);
}

TEST(Measure, UniformSettingsSampleAllBlocksAlike) {
  for (std::uint64_t number = 1; number <= 5; ++number) {
    const field_cases::Field field = field_cases::random_function(21, number);
    const auto settings =
        field_cases::uniform_settings(field_cases::settings_of(field.width, field.height));
    const auto image =
        field_cases::synthesize_image(field_cases::sampler_of(field), settings, 4, 1);
    std::uint32_t least = image.samples(0, 0);
    std::uint32_t most = least;
    for (std::size_t y = 0; y < image.blocks_y(); ++y) {
      for (std::size_t x = 0; x < image.blocks_x(); ++x) {
        least = std::min(least, image.samples(x, y));
        most = std::max(most, image.samples(x, y));
      }
    }
    EXPECT_LE(most - least, least / 20) << field.name;
  }
}

TEST(Measure, DisplayIsTheEncodingOfTheLibrary) {
  const freqsynth::DisplayEncoding encoding;
  for (const float v : {0.0f, 0.002f, 0.18f, 0.7f, 1.0f, 1.5f, -0.1f}) {
    EXPECT_NEAR(255 * field_cases::display(static_cast<double>(v)),
                static_cast<double>(encoding.encode(v)), 1e-3);
  }
}

}  // namespace
