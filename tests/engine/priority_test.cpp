// SPDX-License-Identifier: MIT
#include "freqsynth/engine/priority.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Case {
  PrioritySettings settings;
  float variance;
};

class PriorityFormula : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Settings, PriorityFormula,
                         testing::Values(Case{{}, 1}, Case{{}, 1e6f}, Case{{0.3, 5, 0.5}, 2},
                                         Case{{1, 1, 0.9}, 1}, Case{{0.01, 0.1, 0}, 3},
                                         Case{{0.5, 0, 0.7}, 1}));

TEST_P(PriorityFormula, IsTheRunningAverageOfUncertaintyAndChange) {
  const auto [settings, variance] = GetParam();
  constexpr std::size_t count = 300;
  const PriorityMetric metric(settings, count);
  oracle::Random random(1);
  const double u = settings.uncertainty * double{variance};
  double expected = u;  // p_0 = U, before any sample
  float variation = 0;
  double largest_change = 0;
  for (std::size_t n = 1; n <= count; ++n) {
    // Samples that change nothing, a little and much.
    const auto change =
        static_cast<float>(random.below(3) == 0 ? 0 : std::pow(random.uniform(0, 1), 8));
    largest_change = std::max(largest_change, double{change});
    variation = metric.variation(variation, change);
    expected =
        (1 - settings.weight) * expected +
        settings.weight * (u * std::pow(settings.decay, static_cast<double>(n)) + double{change});
    // Each step of the running average rounds three times, older errors fade; a floor of 1e-12 of
    // the variance orders blocks that never changed.
    const double tolerance =
        4 * oracle::float_rounding * (expected + largest_change) / settings.weight +
        1e-12 * double{variance};
    ASSERT_NEAR(metric.priority(variation, n, variance), expected, tolerance) << n << " samples";
  }
}

TEST(Priority, WeightOneLooksAtTheLastSampleOnly) {
  PrioritySettings settings;
  settings.weight = 1;
  const PriorityMetric metric(settings, 10);
  EXPECT_EQ(metric.variation(123, 4), 4);
  EXPECT_EQ(metric.variation(123, 0), 0);
}

TEST(Priority, BlocksThatNeverChangeStayInTheOrderOfTheirSamples) {
  for (const double uncertainty : {0.0, 1.0}) {
    PrioritySettings settings;
    settings.uncertainty = uncertainty;
    const PriorityMetric metric(settings, 5000);
    for (std::size_t n = 2; n <= 5000; ++n) {
      ASSERT_LT(metric.priority(0, n, 1), metric.priority(0, n - 1, 1)) << n << " samples";
      ASSERT_GT(metric.priority(0, n, 1), 0);
    }
  }
}

TEST(Priority, ScalesWithTheSquareOfTheSignal) {
  const PriorityMetric metric(PrioritySettings{}, 100);
  for (std::size_t n = 1; n <= 100; ++n) {
    const float small = metric.priority(0.25f, n, 3);
    EXPECT_EQ(metric.priority(0.25f * 4096, n, 3 * 4096), 4096 * small);
  }
}

TEST(Priority, MoreChangeIsMoreUrgent) {
  const PriorityMetric metric(PrioritySettings{}, 100);
  for (std::size_t n = 1; n <= 100; ++n) {
    EXPECT_GT(metric.priority(metric.variation(0.1f, 0.5f), n, 1),
              metric.priority(metric.variation(0.1f, 0.4f), n, 1));
  }
}

TEST(ExpectedGain, IsTheErrorTimesTheShareOfAStepPerSample) {
  PrioritySettings settings;
  settings.uncertainty = 0;
  const PriorityMetric metric(settings, 300);
  // A step from a to b samples, by hand.
  const auto expect = [&](std::size_t n, double a, double b) {
    const double error = 0.5 * 64 / static_cast<double>(n);
    const double expected = error * (1 - std::pow(a / b, 1.5)) / (b - a);
    EXPECT_NEAR(double{metric.expected_gain(0.5f, n, 0)}, expected, 1e-6 * expected) << n;
  };
  expect(1, 1, 4);
  expect(4, 4, 5);
  expect(5, 5, 9);
  expect(24, 13, 25);
  expect(25, 25, 41);
  expect(40, 25, 41);
  expect(41, 41, 81);
  expect(100, 81, 145);
  expect(288, 145, 289);
  expect(289, 289, 545);
}

TEST(ExpectedGain, FadesTheDoubtOfBlocksThatAreFlat) {
  PrioritySettings settings;
  settings.uncertainty = 2;
  settings.decay = 0.5;
  const PriorityMetric metric(settings, 100);
  for (std::size_t n = 1; n <= 100; ++n) {
    const auto samples = static_cast<double>(n);
    const double doubt = 3 * 2 * std::pow(0.5, samples) / samples;
    // And 1e-12 of the variance for the order of blocks without any.
    const double expected = double{metric.expected_gain(static_cast<float>(doubt), n, 0)};
    EXPECT_NEAR(double{metric.expected_gain(0, n, 3)}, expected, 1e-6 * expected + 3e-12) << n;
  }
}

TEST(ExpectedGain, FallsWithTheNumberOfSamples) {
  const PriorityMetric metric(PrioritySettings{}, 70000);
  for (std::size_t n = 2; n <= 70000; ++n) {
    ASSERT_LT(metric.expected_gain(1, n, 1), metric.expected_gain(1, n - 1, 1)) << n;
  }
}

// Blocks that are about alike all end a step before one of them begins the next.
TEST(ExpectedGain, PrefersToEndAStep) {
  const PriorityMetric metric({.uncertainty = 0}, 1000);
  for (const std::size_t even : {25u, 41u, 81u, 145u, 289u, 545u}) {
    EXPECT_GT(metric.expected_gain(1, even - 1, 0), 1.25f * metric.expected_gain(1, even, 0))
        << even;
  }
}

TEST(Priority, WrongSettingsAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto refuses = [](const PrioritySettings& settings, const char* field, const char* value) {
    const auto message =
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(field), HasSubstr(value)));
    EXPECT_THAT([&] { settings.validate(); }, message);
    EXPECT_THAT([&] { PriorityMetric(settings, 10); }, message);
  };
  refuses({0, 1, 0.5}, "weight", "0");
  refuses({1.5, 1, 0.5}, "weight", "1.5");
  refuses({-0.25, 1, 0.5}, "weight", "-0.25");
  refuses({nan, 1, 0.5}, "weight", "nan");
  refuses({0.3, -3, 0.5}, "uncertainty", "-3");
  refuses({0.3, infinity, 0.5}, "uncertainty", "inf");
  refuses({0.3, nan, 0.5}, "uncertainty", "nan");
  refuses({0.3, 1, 1}, "decay", "1");
  refuses({0.3, 1, -0.5}, "decay", "-0.5");
  refuses({0.3, 1, nan}, "decay", "nan");
  for (const double exposure : {0.0, -1.0, 1e-31, 1e31, nan, infinity}) {
    PrioritySettings settings;
    settings.exposure = exposure;
    EXPECT_THAT([&] { settings.validate(); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("exposure")))
        << exposure;
  }
  PrioritySettings steered;
  steered.steer = static_cast<Steer>(3);
  refuses(steered, "steer", "3");
  steered.steer = Steer::display;
  EXPECT_NO_THROW(steered.validate());
  EXPECT_NO_THROW(PrioritySettings{}.validate());
  EXPECT_NO_THROW((PrioritySettings{1, 0, 0}.validate()));
}

}  // namespace
}  // namespace freqsynth
