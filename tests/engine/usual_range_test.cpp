// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "freqsynth/engine/signal_statistics.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

std::vector<float> random_values(std::size_t count, unsigned seed) {
  oracle::Random random(seed);
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(static_cast<float>(random.uniform(-3, 7)));
  }
  return values;
}

TEST(UsualRange, IsAllButTheThreeHighestAndLowestOfSortedValues) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    UsualRange range;
    std::vector<float> values = random_values(8 + 7 * seed, seed), seen, let_go, kept;
    for (const float value : values) {
      if (const auto displaced = range.add(value)) let_go.push_back(*displaced);
      seen.push_back(value);
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(range.width(), seen[seen.size() - 4] - seen[3]);
    range.visit_kept([&](float value) { kept.push_back(value); });
    EXPECT_EQ(kept.size(), 8u);
    // None is lost, none comes twice.
    kept.insert(kept.end(), let_go.begin(), let_go.end());
    std::sort(kept.begin(), kept.end());
    EXPECT_EQ(kept, seen);
  }
}

TEST(UsualRange, FewValuesMakeNone) {
  UsualRange range;
  for (const float value : {5.0f, -3.0f, 8.0f, 0.0f, 1.0f, 2.0f, 9.0f}) {
    range.add(value);
    EXPECT_EQ(range.width(), 0);
    EXPECT_EQ(range.plausible(1e9f), 1e9f);
  }
  range.add(4);
  EXPECT_EQ(range.width(), 4.0f - 2.0f) << "of -3 0 1 2 4 5 8 9";
}

TEST(UsualRange, StrayIsWhatLiesOutsideByMoreThanItsWidth) {
  UsualRange range;
  for (int i = 0; i <= 100; ++i) range.add(static_cast<float>(i));  // 3 .. 97
  EXPECT_EQ(range.width(), 94);
  EXPECT_EQ(range.plausible(97 + 94), 97 + 94);
  EXPECT_EQ(range.plausible(97 + 95), 97);
  EXPECT_EQ(range.plausible(3 - 94), 3 - 94);
  EXPECT_EQ(range.plausible(3 - 95), 3);
  EXPECT_EQ(range.plausible(50), 50);
}

TEST(SignalStatistics, OneStrayCornerChangesNothing) {
  const std::vector<float> weights{1};
  for (const float stray : {100.0f, 1e6f, -1e9f, 1e15f}) {
    SignalStatistics with(1), without(1);
    const std::vector<float> values = random_values(2000, 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
      with.add(i == 500 ? &stray : &values[i]);
      without.add(&values[i]);
    }
    with.settle(weights);
    without.settle(weights);
    // One of 2000 values has become the end of the range.
    EXPECT_NEAR(with.variance(), without.variance(), 0.005f * without.variance()) << stray;
    EXPECT_NEAR(with.rounding(), without.rounding(), 0.01f * without.rounding()) << stray;
  }
}

TEST(SignalStatistics, NoValuesInTheRangeHaveALargerVariance) {
  SignalStatistics signal(2);
  const std::vector<float> weights{0.5f, 2};
  EXPECT_GT(signal.most_variance(0), 1e30f) << "nothing is known";
  for (int i = 0; i < 100; ++i) {
    const float values[2] = {i % 2 == 0 ? 3.0f : 7.0f, i % 2 == 0 ? -1.0f : 1.0f};
    signal.note(values);
    signal.add(values);
  }
  EXPECT_GT(signal.most_variance(0), 1e30f) << "not before it is settled";
  signal.settle(weights);
  // Half of the values at each end: the variance is (7 - 3)^2 / 4.
  EXPECT_FLOAT_EQ(signal.most_variance(0), 4);
  EXPECT_FLOAT_EQ(signal.most_variance(0), signal.variance(0));
  EXPECT_FLOAT_EQ(signal.most_variance(1), 1);
  EXPECT_FLOAT_EQ(signal.most_variance(weights), 0.5f * 4 + 2 * 1);
}

}  // namespace
}  // namespace freqsynth
