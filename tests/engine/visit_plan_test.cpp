// SPDX-License-Identifier: MIT
#include "freqsynth/engine/visit_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

TEST(VisitLength, IsAnEighthAndEndsWhereAStepOfTheSequenceDoes) {
  // Even after 1, 4, 5, 9, 13, 25, 41, 81, 145, 289, 545 samples, and so on.
  const std::vector<std::size_t> even = {1, 4, 5, 9, 13, 25, 41, 81, 145, 289, 545, 1089};
  for (std::size_t most = 1; most <= 8; ++most) {
    for (std::size_t samples = 0; samples < 1089; ++samples) {
      std::size_t expected = 1;
      while (samples >= 25 && expected < most && 8 * (expected + 1) <= samples) ++expected;
      const std::size_t end = *std::upper_bound(even.begin(), even.end(), samples);
      expected = std::min(expected, end - samples);
      ASSERT_EQ(visit_length(samples, most), expected) << samples << " samples";
    }
  }
}

TEST(VisitLength, IsAtMostEight) {
  for (std::size_t most_samples = 1; most_samples < 200; ++most_samples) {
    std::size_t longest = 0;
    for (std::size_t samples = 0; samples <= most_samples; ++samples) {
      longest = std::max<std::size_t>(longest, visit_length(samples, 8));
    }
    EXPECT_LE(longest, longest_visit(most_samples));
    EXPECT_LE(longest_visit(most_samples), 8u);
  }
}

TEST(VisitPlan, FollowsATableThroughRandomChanges) {
  // Of so many blocks a few visits are sorted in another way than many.
  constexpr std::size_t blocks = 64 * 640;
  VisitPlan plan(blocks);
  oracle::Random random(1);
  for (const std::size_t count : {0u, 1u, 9u, 11u, 700u, 40000u, 3u}) {
    std::map<std::uint32_t, Visit> expected;
    for (std::size_t i = 0; i < count; ++i) {
      const auto block = static_cast<std::uint32_t>(random.below(blocks));
      ASSERT_EQ(plan.contains(block), expected.count(block) != 0);
      if (plan.contains(block)) continue;
      const auto first = static_cast<std::uint32_t>(random.below(100));
      plan.add({.block = block, .first = first, .asked = 1, .count = 1});
      expected[block] = plan.of(block);
    }
    for (auto& [block, visit] : expected) {
      EXPECT_EQ(plan.of(block).first, visit.first);
      plan.of(block).count = visit.count = 1 + static_cast<std::uint32_t>(random.below(9));
    }
    plan.sort();
    ASSERT_EQ(plan.size(), expected.size());
    EXPECT_EQ(plan.empty(), expected.empty());
    std::size_t at = 0;
    for (const auto& [block, visit] : expected) {
      ASSERT_EQ(plan.visits()[at].block, block) << "in the order of the blocks";
      ASSERT_EQ(&plan.visits()[at], &plan.of(block));
      ASSERT_EQ(plan.of(block).first, visit.first);
      ASSERT_EQ(plan.of(block).end(), visit.first + visit.count);
      ++at;
    }
    plan.clear();
    EXPECT_TRUE(plan.empty());
    for (const auto& [block, visit] : expected) ASSERT_FALSE(plan.contains(block));
  }
}

TEST(VisitPlan, KnowsTheSourceOfEachSample) {
  VisitPlan plan(10);
  plan.reserve(5);
  plan.add({.block = 7, .first = 20, .asked = 2, .count = 3});
  plan.add({.block = 2, .first = 5, .asked = 2, .count = 2});
  plan.sort();
  std::uint32_t number = 100;
  for (Visit& visit : plan.visits()) {
    visit.begin = static_cast<std::uint32_t>(plan.source_count());
    for (std::uint32_t i = visit.first; i < visit.end(); ++i) {
      plan.add_source({number, number % 2 == 1});
      ++number;
    }
  }
  const auto expect = [&](std::uint32_t block, std::uint32_t index, std::uint32_t expected) {
    const ValueSource& source = plan.source(plan.of(block), index);
    EXPECT_EQ(source.number, expected);
    EXPECT_EQ(source.known, expected % 2 == 1);
  };
  expect(2, 5, 100);
  expect(2, 6, 101);
  expect(7, 20, 102);
  expect(7, 22, 104);
  EXPECT_EQ(plan.of(7).asked_end(), 22u);
}

TEST(VisitPlan, MayBeOfNoBlocks) {
  VisitPlan plan(0);
  plan.sort();
  plan.clear();
  EXPECT_TRUE(plan.empty());
}

}  // namespace
}  // namespace freqsynth
