// SPDX-License-Identifier: MIT
// K4: small things in flat parts, while something else is busy.

#include <numbers>

#include "fields/field_helpers.h"

namespace {

constexpr std::uint64_t places = 200;

// How many of 200 discs have less than 2 percent of their light in the picture.
int missed(double radius, int busy) {
  int count = 0;
  for (std::uint64_t number = 1; number <= places; ++number) {
    const field_cases::LostDisc member =
        field_cases::random_disc(helpers::member_seed, number, radius, busy);
    const field_cases::Sampler sampler = field_cases::sampler_of(member.field);
    const field_cases::Picture picture =
        field_cases::synthesize(sampler, field_cases::settings_of(128, 64), 1, 1 + number % 3);
    double light = 0;
    for (std::size_t j = 0; j < 64; ++j) {
      for (std::size_t i = 0; i < 64; ++i) {
        const double x = static_cast<double>(i) + 0.5 - member.disc.x;
        const double y = static_cast<double>(j) + 0.5 - member.disc.y;
        if (std::hypot(x, y) <= radius + 2) light += picture.at(i, j);
      }
    }
    count += light < 0.02 * std::numbers::pi * radius * radius;
  }
  return count;
}

TEST(SmallFeatures, DiscsAloneAreFound) {
  EXPECT_EQ(missed(1.2, 0), 0);
  EXPECT_LE(missed(0.8, 0), static_cast<int>(places / 20));
}

}  // namespace
