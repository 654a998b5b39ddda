// SPDX-License-Identifier: MIT
#include "freqsynth/image/butterworth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "freqsynth/basis/dct.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t sample_counts[] = {1, 2, 4, 5, 25, 64, 81, 289, 1000, 1050625};

TEST(Butterworth, IsTheLiteralFormula) {
  for (const auto& settings : {ButterworthSettings{}, ButterworthSettings{true, 1.5, 1},
                               ButterworthSettings{true, 0.1, 3.5}}) {
    for (const std::size_t samples : sample_counts) {
      const auto factors = butterworth_factors(settings, samples);
      const double d0 = settings.cutoff * std::sqrt(static_cast<double>(samples));
      for (std::size_t i = 0; i < max_terms; ++i) {
        const double d = std::hypot(oracle::horizontal(i), oracle::vertical(i));
        const double expected = 1 / (1 + std::pow(d / d0, 2 * settings.order));
        // Computed in double, rounded once.
        ASSERT_NEAR(factors[i], expected, 1.01 * oracle::float_rounding * expected);
      }
    }
  }
}

TEST(Butterworth, KeepsTheMeanExactly) {
  for (const std::size_t samples : sample_counts) {
    EXPECT_EQ(butterworth_factors({}, samples)[0], 1);
    EXPECT_EQ(butterworth_factors({true, 1e-3, 0.1}, samples)[0], 1);
  }
}

TEST(Butterworth, IsOneHalfAtTheCutoff) {
  // c sqrt(n) = 5 is the distance of (3, 4), (4, 3), (5, 0) and (0, 5).
  const auto factors = butterworth_factors({true, 1, 7}, 25);
  for (const auto& [u, v] : {std::pair<std::size_t, std::size_t>{3, 4}, {4, 3}, {5, 0}, {0, 5}}) {
    EXPECT_FLOAT_EQ(factors[term_of_frequency(u, v)], 0.5f);
  }
}

TEST(Butterworth, PassesMoreWithMoreSamplesAndLessWithHigherFrequency) {
  for (std::size_t k = 0; k + 1 < std::size(sample_counts); ++k) {
    const auto few = butterworth_factors({}, sample_counts[k]);
    const auto many = butterworth_factors({}, sample_counts[k + 1]);
    for (std::size_t i = 1; i < max_terms; ++i) {
      EXPECT_LE(few[i], many[i]);
      EXPECT_LE(many[i], 1.0f);
      for (std::size_t j = 1; j < max_terms; ++j) {
        if (std::hypot(oracle::horizontal(i), oracle::vertical(i)) <
            std::hypot(oracle::horizontal(j), oracle::vertical(j))) {
          EXPECT_GE(few[i], few[j]);
        }
      }
    }
  }
}

TEST(Butterworth, IsOneWhenSwitchedOff) {
  EXPECT_THAT(butterworth_factors({false, 0.8, 2}, 5), Each(1.0f));
  EXPECT_THAT(butterworth_factors({false, 0.8, 2}, 0), Each(1.0f));
}

TEST(Butterworth, WithoutSamplesOnlyTheMeanPasses) {
  const auto factors = butterworth_factors({}, 0);
  EXPECT_EQ(factors[0], 1);
  for (std::size_t i = 1; i < max_terms; ++i) EXPECT_EQ(factors[i], 0);
}

TEST(ButterworthTable, IsFilterTimesScaleInAnyOrderOfCounts) {
  oracle::Random random(8);
  const auto scale = random.values<max_terms>();
  const ButterworthSettings settings{true, 0.7, 1.5};
  detail::ButterworthTable table(settings, scale);
  // New counts below, between and above the old ones, and old ones again.
  for (int i = 0; i < 2000; ++i) {
    const auto samples =
        static_cast<std::uint32_t>(i % 7 == 6 ? 4294967295 - random.below(5) : random.below(300));
    auto expected = butterworth_factors(settings, samples);
    for (std::size_t k = 0; k < max_terms; ++k) expected[k] *= scale[k];
    ASSERT_EQ(table.of(samples), expected) << samples;
  }
}

TEST(Butterworth, WrongSettingsAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto refuses = [](const ButterworthSettings& settings, const char* field,
                          const char* value) {
    EXPECT_THAT([&] { settings.validate(); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(field), HasSubstr(value))));
  };
  refuses({true, 0, 2}, "butterworth.cutoff", "is 0, not a finite number > 0");
  refuses({true, -0.5, 2}, "butterworth.cutoff", "is -0.5, not");
  refuses({true, -1e-300, 2}, "butterworth.cutoff", "is -1e-300, not");
  refuses({true, nan, 2}, "butterworth.cutoff", "is nan, not");
  refuses({true, infinity, 2}, "butterworth.cutoff", "is inf, not");
  refuses({true, 0.8, 0}, "butterworth.order", "is 0, not");
  refuses({true, 0.8, -2.5}, "butterworth.order", "is -2.5, not");
  refuses({true, 0.8, nan}, "butterworth.order", "is nan, not");
  refuses({true, 0.8, infinity}, "butterworth.order", "is inf, not");
  EXPECT_NO_THROW(ButterworthSettings{}.validate());
}

}  // namespace
}  // namespace freqsynth
