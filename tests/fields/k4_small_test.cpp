// SPDX-License-Identifier: MIT
// K4: small things in flat parts, while something else is busy.

#include <limits>
#include <numbers>
#include <optional>

#include "fields/field_helpers.h"

namespace {

constexpr std::uint64_t places = 200;

// How many of 200 discs have less than 2 percent of their light in the picture.
int missed(double radius, int busy, bool until_quality) {
  int count = 0;
  for (std::uint64_t number = 1; number <= places; ++number) {
    const field_cases::LostDisc member =
        field_cases::random_disc(helpers::member_seed, number, radius, busy);
    field_cases::Sampler sampler = field_cases::sampler_of(member.field);
    auto settings = field_cases::settings_of(128, 64);
    double rate = 1;
    double radiance = 1;
    if (until_quality) {
      freqsynth::QuantizationSettings tables;
      tables.luminance = freqsynth::scale_table(freqsynth::luminance_table(), 75);
      settings.quantization = freqsynth::quantization_target(tables, 1);
      settings.quantization->most_samples = 512;  // of the busy half: it would take 4096
      sampler = [plain = sampler](double x, double y, std::uint64_t id, std::span<float> values) {
        plain(x, y, id, values);
        values[0] *= 255;
      };
      rate = std::numeric_limits<double>::infinity();
      radiance = 255;
    }
    const field_cases::Picture picture =
        field_cases::synthesize(sampler, settings, rate, 1 + number % 3);
    double light = 0;
    for (std::size_t j = 0; j < 64; ++j) {
      for (std::size_t i = 0; i < 64; ++i) {
        const double x = static_cast<double>(i) + 0.5 - member.disc.x;
        const double y = static_cast<double>(j) + 0.5 - member.disc.y;
        if (std::hypot(x, y) <= radius + 2) light += picture.at(i, j);
      }
    }
    count += light < 0.02 * std::numbers::pi * radius * radius * radiance;
  }
  return count;
}

TEST(SmallFeatures, DiscsOfAPixelAreFoundBesideAnythingBusy) {
  for (int busy = 1; busy <= 4; ++busy) {
    EXPECT_LE(missed(1.2, busy, false), static_cast<int>(places / 20)) << "beside " << busy;
    EXPECT_LE(missed(0.8, busy, false), static_cast<int>(3 * places / 10)) << "beside " << busy;
  }
}

TEST(SmallFeatures, DiscsAloneAreFound) {
  EXPECT_EQ(missed(1.2, 0, false), 0);
  EXPECT_LE(missed(0.8, 0, false), static_cast<int>(places / 20));
}

TEST(SmallFeatures, DiscsAreFoundInRunsUntilQuality) {
  EXPECT_LE(missed(1.2, 1, true), static_cast<int>(places / 20));
  EXPECT_LE(missed(0.8, 1, true), static_cast<int>(3 * places / 10));
}

}  // namespace
