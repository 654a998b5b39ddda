// SPDX-License-Identifier: MIT
#include "freqsynth/engine/signal_statistics.h"
#include "freqsynth/refine/refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::double_rounding;
using oracle::float_rounding;
using oracle::Real;

/// Values of the corners: one row per corner, one value per channel.
using Corners = std::vector<std::vector<float>>;

Corners random_corners(std::size_t count, const std::vector<double>& means, double spread,
                       unsigned seed) {
  oracle::Random random(seed);
  Corners corners(count);
  for (auto& corner : corners) {
    for (const double mean : means) {
      corner.push_back(static_cast<float>(mean + spread * random.uniform(-1, 1)));
    }
  }
  return corners;
}

SignalStatistics settled(const Corners& corners, const std::vector<float>& weights) {
  SignalStatistics signal(weights.size());
  for (const auto& corner : corners) signal.add(corner.data());
  signal.settle(weights);
  return signal;
}

Real mean(const Corners& corners, std::size_t channel, int power) {
  Real sum = 0;
  for (const auto& corner : corners) sum += std::pow(static_cast<Real>(corner[channel]), power);
  return sum / static_cast<Real>(corners.size());
}

/// In two passes: the mean first.
Real variance(const Corners& corners, std::size_t channel) {
  const Real middle = mean(corners, channel, 1);
  Real sum = 0;
  for (const auto& corner : corners) {
    sum += std::pow(static_cast<Real>(corner[channel]) - middle, 2);
  }
  return sum / static_cast<Real>(corners.size());
}

TEST(SignalStatistics, VarianceIsThatOfTwoPasses) {
  for (const std::size_t count : {2u, 3u, 50u, 4000u}) {
    const Corners corners = random_corners(count, {0, 3, -40}, 1.5, static_cast<unsigned>(count));
    const std::vector<float> weights = {0.5f, 0, 2};
    const SignalStatistics signal = settled(corners, weights);
    Real sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto expected = static_cast<double>(variance(corners, c));
      const auto square = static_cast<double>(mean(corners, c, 2));
      // The result's rounding to float, and that of the sums, which the mean may exceed by far.
      const double bound =
          float_rounding * expected + 4 * static_cast<double>(count) * double_rounding * square;
      EXPECT_NEAR(signal.variance(c), expected, bound) << count << " corners, channel " << c;
      sum += static_cast<Real>(weights[c]) * variance(corners, c);
    }
    const auto expected = static_cast<double>(sum);
    EXPECT_NEAR(signal.variance(), expected, 1e-6 * expected) << count << " corners";
  }
}

TEST(SignalStatistics, AFlatSignalLeavesDoubtInProportionToItsLevel) {
  for (const float level : {1.0f, -0.03f, 250.0f, 1e15f}) {
    const SignalStatistics signal = settled(Corners(10, {level}), {1});
    const double expected = 1e-6 * double{level} * double{level};
    EXPECT_NEAR(signal.variance(0), expected, 4 * float_rounding * expected);
    EXPECT_EQ(signal.variance(), signal.variance(0));
  }
}

TEST(SignalStatistics, TheDoubtIsTheLeast) {
  // Around 1 as far as 0.001: a variance of 1e-6. A little less or more.
  for (const float distance : {0.0005f, 0.0009f, 0.0011f, 0.002f}) {
    const Corners corners = {{1 - distance}, {1 + distance}};
    const SignalStatistics signal = settled(corners, {1});
    const Real square = mean(corners, 0, 2);
    const auto expected =
        static_cast<double>(std::max(variance(corners, 0), static_cast<Real>(1e-6) * square));
    EXPECT_NEAR(signal.variance(), expected, 1e-6 * expected) << distance;
  }
}

TEST(SignalStatistics, ChannelsWithoutWeightChangeNotABit) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    oracle::Random random(seed);
    const std::size_t own = 1 + random.below(4), others = 1 + random.below(20);
    std::vector<double> means;
    std::vector<float> weights;
    for (std::size_t c = 0; c < own; ++c) {
      means.push_back(random.uniform(-5, 5));
      weights.push_back(static_cast<float>(random.uniform(0.01, 1)));
    }
    const Corners alone = random_corners(100, means, 1, seed);
    const SignalStatistics expected = settled(alone, weights);
    Corners corners = alone;
    weights.resize(own + others);
    for (auto& corner : corners) {
      for (std::size_t c = 0; c < others; ++c) corner.push_back(random.value() * 1e30f);
    }
    const SignalStatistics signal = settled(corners, weights);
    EXPECT_EQ(signal.variance(), expected.variance()) << seed;
    EXPECT_EQ(signal.rounding(), expected.rounding()) << seed;
  }
}

TEST(SignalStatistics, NothingAtAllLeavesDoubtToo) {
  // Whoever asks for a variance of 0 learns that it is not settled.
  for (const SignalStatistics& signal :
       {settled({}, {0.5f, 0.5f}), settled(Corners(7, {0, 0}), {0.5f, 0.5f})}) {
    EXPECT_FLOAT_EQ(signal.variance(), 1e-24f);
    EXPECT_FLOAT_EQ(signal.variance(1), 1e-24f);
    EXPECT_EQ(signal.rounding(), 0);
  }
}

TEST(SignalStatistics, IsZeroUntilItIsSettled) {
  SignalStatistics signal(2);
  const float values[] = {1, 2};
  signal.add(values);
  EXPECT_EQ(signal.variance(), 0);
  EXPECT_EQ(signal.variance(0), 0);
  EXPECT_EQ(signal.variance(1), 0);
  EXPECT_EQ(signal.rounding(), 0);
}

TEST(SignalStatistics, ScalesExactlyByPowersOfTwo) {
  const Corners corners = random_corners(100, {0.5, 20}, 1, 9);
  const std::vector<float> weights = {0.25f, 3};
  const SignalStatistics signal = settled(corners, weights);
  for (const int exponent : {-20, -3, 1, 10, 30}) {
    Corners scaled = corners;
    for (auto& corner : scaled) {
      for (float& value : corner) value = std::ldexp(value, exponent);
    }
    const SignalStatistics other = settled(scaled, weights);
    EXPECT_EQ(other.variance(), std::ldexp(signal.variance(), 2 * exponent));
    EXPECT_EQ(other.variance(0), std::ldexp(signal.variance(0), 2 * exponent));
    EXPECT_EQ(other.variance(1), std::ldexp(signal.variance(1), 2 * exponent));
    EXPECT_EQ(other.rounding(), std::ldexp(signal.rounding(), 2 * exponent));
  }
}

TEST(SignalStatistics, RoundingIsAShareOfTheWeightedPower) {
  const Corners corners = random_corners(60, {1, -8, 100}, 2, 10);
  const std::vector<float> weights = {2, 0, 0.125f};
  Real expected = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    expected += static_cast<Real>(1e-12) * mean(corners, c, 2) * static_cast<Real>(weights[c]);
  }
  SignalStatistics signal = settled(corners, weights);
  EXPECT_NEAR(signal.rounding(), static_cast<double>(expected),
              8 * float_rounding * static_cast<double>(expected));
  // Settling again with nothing new changes nothing.
  const float before = signal.rounding();
  const float variance_before = signal.variance();
  signal.settle(weights);
  EXPECT_EQ(signal.rounding(), before);
  EXPECT_EQ(signal.variance(), variance_before);
}

TEST(SignalStatistics, LargestStateValuesStayFinite) {
  Corners corners;
  for (int i = 0; i < 1000; ++i) {
    corners.push_back({i % 2 == 0 ? most_state_value : -most_state_value});
  }
  const SignalStatistics signal = settled(corners, {4});
  EXPECT_FLOAT_EQ(signal.variance(), 4 * most_state_value * most_state_value);
  EXPECT_FLOAT_EQ(signal.rounding(), 4e-12f * most_state_value * most_state_value);
}

}  // namespace
}  // namespace freqsynth
