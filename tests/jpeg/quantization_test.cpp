// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/quantization.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "freqsynth/image/butterworth.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using oracle::Real;
using test::random_signal;
using test::random_table;
using test::uniform_table;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

// ------------------------------------------------------------------------------------- tables

// As printed in ITU-T T.81, tables K.1 and K.2.
constexpr std::array<int, 64> k1 = {
    16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,   //
    14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,   //
    18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,   //
    49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};  //
constexpr std::array<int, 64> k2 = {
    17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99,   //
    24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,   //
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,   //
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99};  //

TEST(QuantizationTables, AreThoseOfTheStandard) {
  for (std::size_t i = 0; i < max_terms; ++i) {
    const auto place = static_cast<std::size_t>(oracle::zigzag[i]);
    EXPECT_EQ(luminance_table()[i], k1[place]) << i;
    EXPECT_EQ(chrominance_table()[i], k2[place]) << i;
  }
}

TEST(ScaleTable, StaysInTheRangeOfBaselineAndNeverGrowsWithQuality) {
  EXPECT_EQ(scale_table(luminance_table(), 50), luminance_table());
  EXPECT_THAT(scale_table(luminance_table(), 100), Each(1));
  EXPECT_THAT(scale_table(uniform_table(65535), 1), Each(255));
  for (int quality = 1; quality <= 100; ++quality) {
    const QuantizationTable table = scale_table(luminance_table(), quality);
    const QuantizationTable finer = scale_table(luminance_table(), std::min(quality + 1, 100));
    for (std::size_t i = 0; i < max_terms; ++i) {
      EXPECT_GE(table[i], 1);
      EXPECT_LE(table[i], 255);
      EXPECT_LE(finer[i], table[i]);
    }
  }
}

TEST(ScaleTable, RefusesQualitiesAndTablesOutOfRange) {
  for (const int quality : {0, 101, -5}) {
    EXPECT_THAT([&] { (void)scale_table(luminance_table(), quality); },
                ThrowsMessage<std::invalid_argument>(
                    HasSubstr("quality is " + std::to_string(quality) + ", not in 1..100")));
  }
  QuantizationTable table = luminance_table();
  table[63] = 0;
  EXPECT_THAT([&] { (void)scale_table(table, 50); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("holds a 0")));
}

// ---------------------------------------------------------------------------------------- eq. 3

/// The quotient of eq. 3 lies within half a step of what was kept. Each of `roundings` roundings to
/// float moves it by its share.
void expect_nearest(std::int16_t kept, Real quotient, int roundings) {
  EXPECT_LE(std::abs(static_cast<Real>(kept) - quotient),
            Real{0.5} + roundings * std::abs(quotient) * oracle::float_rounding);
}

TEST(Quantize, IsEquation3) {
  const FrequencyImage image = random_signal(40, 24, 3, CoefficientMeaning::pixel_average);
  QuantizationSettings settings;
  settings.luminance = random_table(1, 300);
  settings.chrominance = random_table(2, 3);
  const QuantizedImage quantized = quantize(image, settings);
  ASSERT_EQ(quantized.components.size(), 3u);
  ASSERT_EQ(quantized.tables.size(), 2u);
  EXPECT_EQ(quantized.tables[0], settings.luminance);
  EXPECT_EQ(quantized.tables[1], settings.chrominance);
  EXPECT_EQ(quantized.clamped, 0u);
  for (std::size_t c = 0; c < 3; ++c) {
    const QuantizedComponent& component = quantized.components[c];
    ASSERT_EQ(component.blocks_x, 5u);
    ASSERT_EQ(component.blocks_y, 3u);
    for (std::size_t b = 0; b < 15; ++b) {
      for (std::size_t i = 0; i < max_terms; ++i) {
        const Real shift = c == 0 && i == 0 ? 1024 : 0;
        const Real value = static_cast<Real>(image.coefficients(b % 5, b / 5, c)[i]) - shift;
        // Two roundings: the shift and the division.
        expect_nearest(component.values[b * max_terms + i],
                       value / quantized.tables[component.table][i], 2);
      }
    }
  }
}

TEST(Quantize, RoundsHalvesAwayFromZeroAndNothingElse) {
  FrequencyImage image(8, 8, 3, CoefficientMeaning::pixel_average);
  for (const float step : {1.0f, 2.0f}) {
    QuantizationSettings settings;
    settings.chrominance = uniform_table(static_cast<std::uint16_t>(step));
    for (int whole = -1023; whole < 1023; ++whole) {
      const float half = static_cast<float>(whole) + 0.5f;
      const std::array<float, 5> numbers = {half, std::nextafter(half, -infinite),
                                            std::nextafter(half, infinite),
                                            static_cast<float>(whole), half + 0.25f};
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        image.coefficients(0, 0, 1)[i] = step * numbers[i];
      }
      const QuantizedImage quantized = quantize(image, settings);
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        // The block is in range, or is clamped value by value: std::round() must be met in both.
        EXPECT_EQ(quantized.components[1].values[i],
                  std::clamp(std::round(numbers[i]), -1023.0f, 1023.0f) -
                      (i == 0 && numbers[i] < -1023 ? 1 : 0))
            << numbers[i];
      }
    }
  }
}

TEST(Quantize, ShiftsTheLevelOfYOnly) {
  FrequencyImage image(8, 8, 3, CoefficientMeaning::pixel_average);
  image.coefficients(0, 0, 0)[0] = 8 * 128 + 16;
  image.coefficients(0, 0, 1)[0] = 8 * -17;
  const QuantizedImage quantized = quantize(image);
  EXPECT_EQ(quantized.components[0].values[0], 1);
  EXPECT_EQ(quantized.components[1].values[0], -8);
  EXPECT_EQ(quantized.components[2].values[0], 0);
}

TEST(Quantize, FiltersPointFunctionsAndLeavesPixelsAlone) {
  const FrequencyImage image = random_signal(40, 24, 1, CoefficientMeaning::point_function);
  for (const bool enabled : {true, false}) {
    QuantizationSettings settings;
    settings.luminance = uniform_table(1);
    settings.butterworth = {enabled, 0.6, 1.5};
    const QuantizedImage quantized = quantize(image, settings);
    for (std::size_t b = 0; b < 15; ++b) {
      const Real cutoff = 0.6L * std::sqrt(static_cast<Real>(image.samples(b % 5, b / 5)));
      for (std::size_t i = 0; i < max_terms; ++i) {
        const Real u = oracle::horizontal(i), v = oracle::vertical(i);
        const auto sinc = [](Real z) {
          return z == 0 ? 1 : std::sin(oracle::pi * z) / (oracle::pi * z);
        };
        Real value = static_cast<Real>(image.coefficients(b % 5, b / 5, 0)[i]);
        value *= sinc(u / 16) * sinc(v / 16);
        if (enabled) value /= 1 + std::pow(std::hypot(u, v) / cutoff, Real{3});
        if (i == 0) value -= 1024;
        // Roundings: both factors, their product, the value; the constant term is exact.
        expect_nearest(quantized.components[0].values[b * max_terms + i], value, 5);
      }
    }
  }
}

TEST(Quantize, ClampsAndCountsWhatBaselineCannotCode) {
  struct Case {
    std::size_t term;
    float quotient;
    int kept;
    bool counted;
  };
  const std::array cases = {
      Case{0, 1023.4f, 1023, false},   Case{0, 1024, 1023, true},
      Case{0, -1024.4f, -1024, false}, Case{0, -1025, -1024, true},
      Case{5, 1023.9f, 1023, false},   Case{5, 1024, 1023, true},
      Case{5, -1023.9f, -1023, false}, Case{5, -1024, -1023, true},
      Case{63, 1e30f, 1023, true},     Case{63, -1e30f, -1023, true},
      Case{63, infinite, 1023, true},  Case{0, -infinite, -1024, true},
      Case{7, not_a_number, 0, true},  Case{0, not_a_number, 0, true},
      Case{7, 0.0f, 0, false},
  };
  for (const Case& c : cases) {
    FrequencyImage image(8, 8, 3, CoefficientMeaning::pixel_average);
    image.coefficients(0, 0, 0)[0] = 1024;
    image.coefficients(0, 0, 2)[c.term] = 4 * c.quotient;
    image.coefficients(0, 0, 2)[20] = -10;
    QuantizationSettings settings;
    settings.chrominance = uniform_table(4);
    const QuantizedImage quantized = quantize(image, settings);
    EXPECT_EQ(quantized.components[2].values[c.term], c.kept) << c.quotient;
    EXPECT_EQ(quantized.components[2].values[20], -3) << c.quotient;
    EXPECT_EQ(quantized.clamped, c.counted ? 1u : 0u) << c.term << ": " << c.quotient;
  }
}

// --------------------------------------------------------------------------------------- errors

TEST(Quantize, RefusesWhatItCannotQuantise) {
  const auto refuses = [](const FrequencyImage& image, const QuantizationSettings& settings,
                          const char* why) {
    EXPECT_THAT([&] { (void)quantize(image, settings); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses(FrequencyImage(), {}, "no pixels");
  refuses(FrequencyImage(0, 8, 3), {}, "no pixels");
  refuses(FrequencyImage(8, 8, 2), {}, "2 channels, not 1 or 3");
  refuses(FrequencyImage(8, 8, 4), {}, "4 channels");
  QuantizationSettings settings;
  settings.luminance[3] = 0;
  refuses(FrequencyImage(8, 8, 1), settings, "luminance quantization table holds a 0");
  settings = {};
  settings.chrominance[63] = 0;
  refuses(FrequencyImage(8, 8, 3), settings, "chrominance quantization table holds a 0");
  settings = {};
  settings.butterworth.cutoff = -1;
  refuses(FrequencyImage(8, 8, 1), settings, "butterworth.cutoff is -1");
}

TEST(QuantizationTargetOfSettings, RefusesWhatQuantizeRefuses) {
  const auto refuses = [](const QuantizationSettings& settings, std::size_t channels,
                          const char* why) {
    EXPECT_THAT([&] { (void)quantization_target(settings, channels); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses({}, 0, "of 0 channels, not 1 or 3");
  refuses({}, 2, "of 2 channels, not 1 or 3");
  QuantizationSettings settings;
  settings.chrominance[63] = 0;
  refuses(settings, 1, "chrominance quantization table holds a 0");
  settings = {};
  settings.butterworth.order = -1;
  refuses(settings, 3, "butterworth.order is -1");
}

TEST(Quantize, CopesWithLargeSampleCounts) {
  FrequencyImage image(64, 8, 1);
  for (std::size_t x = 0; x < 8; ++x) {
    image.samples(x, 0) = std::numeric_limits<std::uint32_t>::max() - static_cast<std::uint32_t>(x);
    image.coefficients(x, 0, 0)[0] = 1024 + 16;
  }
  const QuantizedImage quantized = quantize(image);
  for (std::size_t x = 0; x < 8; ++x) EXPECT_EQ(quantized.components[0].values[x * max_terms], 1);
}

}  // namespace
}  // namespace freqsynth
