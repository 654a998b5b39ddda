// SPDX-License-Identifier: MIT
// Which samples are asked for twice, and when two values differ.
#include "freqsynth/engine/noise_probes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>

#include "support/oracles.h"

namespace freqsynth {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(NoiseProbes, OneOfTheSamplesBetweenTwoSquaresIsAskedForTwice) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    oracle::Random random(seed);
    NoiseProbes probes;
    std::set<std::uint64_t> all;
    std::uint64_t before = 0;
    while (before < 100000) {
      const std::size_t count = seed == 0 ? 1 : random.below(seed * 100) + 1;
      std::size_t met = 0;
      probes.visit(before, count, [&](std::size_t i) {
        ASSERT_LT(i, count);
        ASSERT_TRUE(all.empty() || before + i > *all.rbegin()) << "in order";
        all.insert(before + i);
        ++met;
      });
      ASSERT_LE(met, NoiseProbes::most(count));
      before += count;
    }
    // The samples k^2 .. (k + 1)^2 - 1, counted from 0.
    for (std::uint64_t k = 1; (k + 1) * (k + 1) <= before; ++k) {
      const auto first = all.lower_bound(k * k);
      ASSERT_NE(first, all.end());
      ASSERT_LT(*first, (k + 1) * (k + 1)) << k;
      ASSERT_TRUE(std::next(first) == all.end() || *std::next(first) >= (k + 1) * (k + 1)) << k;
    }
    EXPECT_GE(*all.begin(), 1u);
  }
}

TEST(NoiseProbes, RoundingIsNoNoise) {
  EXPECT_FALSE(NoiseProbes::differ(1, 1));
  EXPECT_FALSE(NoiseProbes::differ(1, 1.00001f));
  EXPECT_FALSE(NoiseProbes::differ(-1e36f, -1.00001e36f));
  EXPECT_FALSE(NoiseProbes::differ(0, 0));
  EXPECT_FALSE(NoiseProbes::differ(0, -0.0f));
  EXPECT_TRUE(NoiseProbes::differ(1, 1.001f));
  EXPECT_TRUE(NoiseProbes::differ(0, 1e-30f));
  EXPECT_TRUE(NoiseProbes::differ(1e36f, -1e36f));
  for (const float bad : {nan, infinity, -infinity, 1e37f}) {
    EXPECT_FALSE(NoiseProbes::differ(bad, 1));
    EXPECT_FALSE(NoiseProbes::differ(1, bad));
    EXPECT_FALSE(NoiseProbes::differ(bad, bad));
  }
}

}  // namespace
}  // namespace freqsynth
