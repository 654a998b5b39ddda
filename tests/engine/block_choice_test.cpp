// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "support/oracles.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using Block = std::uint32_t;
using helpers::ScriptedRefiner;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// What a measure is to say of each block, and what it was told and asked.
struct Script {
  explicit Script(std::size_t blocks) : priorities(blocks), news(blocks) {}

  std::vector<float> priorities;
  std::vector<bool> news;
  float cares_below = infinity;

  std::vector<std::pair<Block, float>> absorbed;
  std::vector<double> added;
  std::vector<std::pair<Block, float>> asked;  // with the factor
  std::vector<Block> asked_for_news;
  std::multiset<float> asked_to_care;
};

class ScriptedMeasure {
 public:
  explicit ScriptedMeasure(Script& script) : script_(&script) {}

  void use_units(const BlockView<ScriptedRefiner>&, float) {}
  [[nodiscard]] bool notice_noise(const BlockView<ScriptedRefiner>&) { return false; }

  void absorbed(const BlockView<ScriptedRefiner>&, Block block, std::span<const float> changes) {
    for (const float change : changes) script_->absorbed.push_back({block, change});
  }
  [[nodiscard]] static bool apart() { return true; }
  double absorbed_apart(const BlockView<ScriptedRefiner>& view, Block block,
                        std::span<const float> changes) {
    absorbed(view, block, changes);
    return static_cast<double>(block);
  }
  void add(double sum) { script_->added.push_back(sum); }
  [[nodiscard]] float priority(const BlockView<ScriptedRefiner>&, Block block, float factor) const {
    script_->asked.push_back({block, factor});
    return factor * script_->priorities[block];
  }
  [[nodiscard]] bool has_news(Block block) {
    script_->asked_for_news.push_back(block);
    return script_->news[block];
  }
  [[nodiscard]] bool cares(float priority) const {
    script_->asked_to_care.insert(priority);
    return priority < script_->cares_below;
  }
  [[nodiscard]] static bool in_units() { return true; }

 private:
  Script* script_;
};

static_assert(BlockMeasure<ScriptedMeasure, ScriptedRefiner>);

using Choice = BlockChoice<ScriptedRefiner, ScriptedMeasure>;

/// An image of 3 x 4 blocks that may have 5 samples each.
class BlockChoiceTest : public testing::Test {
 protected:
  static constexpr std::size_t most = 5;

  [[nodiscard]] BlockView<ScriptedRefiner> view() const { return {grid_, blocks_, signal_}; }
  void sample(Block block, std::size_t times = 1) {
    const float value = 1;
    for (std::size_t i = 0; i < times; ++i) blocks_.absorb(block, &value);
  }
  void sample_all() {
    for (Block block = 0; block < grid_.size(); ++block) sample(block);
  }
  /// All blocks in the order in which they would be taken.
  static std::vector<std::pair<Block, float>> order(Choice choice) {
    std::vector<std::pair<Block, float>> taken;
    while (choice.top_priority() != BlockQueue::absent) {
      const float priority = choice.top_priority();
      const Block block = choice.take();
      taken.push_back({block, priority});
      if (taken.size() > 12) break;
    }
    return taken;
  }
  /// The blocks of a table, searched for the highest priority again and again.
  static std::vector<std::pair<Block, float>> sorted(std::vector<float> table) {
    std::vector<std::pair<Block, float>> expected;
    for (;;) {
      Block first = 0;
      for (Block block = 1; block < table.size(); ++block) {
        if (table[block] > table[first]) first = block;
      }
      if (table[first] == BlockQueue::absent) return expected;
      expected.push_back({first, table[first]});
      table[first] = BlockQueue::absent;
    }
  }

  BlockGrid grid_ = BlockGrid::of(24, 32, 1);
  BlockStore<ScriptedRefiner> blocks_{ScriptedRefiner({1}), grid_.size(), most};
  SignalStatistics signal_{1};
  Script script_{grid_.size()};
  std::vector<float> factors_ = std::vector<float>(grid_.size(), 1);
};

TEST_F(BlockChoiceTest, IsEmptyAtFirst) {
  const Choice choice(ScriptedMeasure(script_), factors_);
  EXPECT_EQ(choice.top_priority(), BlockQueue::absent);
}

TEST_F(BlockChoiceTest, TakesTheHighestPriorityAndOfEqualsTheLowestNumber) {
  sample_all();
  oracle::Random random(1);
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::vector<float> expected;
    for (std::size_t b = 0; b < 12; ++b) {
      script_.priorities[b] = static_cast<float>(random.below(4));
      factors_[b] = 0.5f + static_cast<float>(random.below(2));
      expected.push_back(script_.priorities[b] * factors_[b]);
    }
    Choice choice(ScriptedMeasure(script_), factors_);
    choice.revise_all(view());
    ASSERT_EQ(order(choice), sorted(expected));
  }
}

TEST_F(BlockChoiceTest, BlocksWithoutASampleAreFirst) {
  for (const Block block : {Block{0}, Block{3}, Block{5}}) sample(block);
  script_.priorities[0] = 2 * most_priority;
  script_.priorities[3] = infinity;
  script_.priorities[5] = 1;
  factors_[7] = 0;  // its first sample it gets
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  for (const Block block : {1u, 2u, 4u, 6u, 7u, 8u, 9u, 10u, 11u}) {
    EXPECT_GT(choice.top_priority(), most_priority);
    EXPECT_EQ(choice.take(), block);
  }
  // Huge priorities are equal, and below.
  EXPECT_EQ(order(choice), (std::vector<std::pair<Block, float>>{
                               {0, most_priority}, {3, most_priority}, {5, 1.0f}}));
  EXPECT_EQ(script_.asked.size(), 3u) << "of the others there is nothing to say";
}

TEST_F(BlockChoiceTest, FullBlocksAreAbsent) {
  sample_all();
  script_.priorities.assign(12, 1);
  script_.priorities[6] = infinity;
  sample(6, most - 1);
  sample(2, most - 2);  // may have one more
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  std::vector<Block> taken;
  for (const auto& [block, priority] : order(choice)) taken.push_back(block);
  EXPECT_EQ(taken, (std::vector<Block>{0, 1, 2, 3, 4, 5, 7, 8, 9, 10, 11}));
  sample(2);
  VisitPlan two(12);
  two.add({.block = 2});
  choice.revise(view(), two, false);
  taken.clear();
  for (const auto& [block, priority] : order(choice)) taken.push_back(block);
  EXPECT_EQ(taken, (std::vector<Block>{0, 1, 3, 4, 5, 7, 8, 9, 10, 11}));
}

TEST_F(BlockChoiceTest, FactorZeroIsNeverWantedAgain) {
  sample_all();
  script_.priorities.assign(12, infinity);
  factors_[4] = 0;
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  for (Block block = 0; block < 12; ++block) EXPECT_EQ(choice.wanted(block), block != 4);
  const auto all = order(choice);
  ASSERT_EQ(all.size(), 12u);
  EXPECT_EQ(all.back(), (std::pair<Block, float>{4, 0.0f})) << "0 times infinity is no number";
}

TEST_F(BlockChoiceTest, WhatIsTakenIsAbsentUntilItIsRevised) {
  sample_all();
  for (std::size_t b = 0; b < 12; ++b) script_.priorities[b] = static_cast<float>(b);
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  EXPECT_EQ(choice.take(), 11u);
  choice.take(9);
  EXPECT_EQ(choice.take(), 10u);
  EXPECT_EQ(choice.take(), 8u);
  VisitPlan some(12);
  some.add({.block = 9});
  some.add({.block = 11});
  script_.priorities[9] = 3.5f;
  choice.revise(view(), some, false);
  EXPECT_EQ(choice.take(), 11u);
  EXPECT_EQ(choice.take(), 7u);
  EXPECT_EQ(choice.top_priority(), 6);
}

TEST_F(BlockChoiceTest, TheMeasureHearsOfEverySample) {
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.absorbed(view(), 4, std::array{0.5f});
  choice.absorbed(view(), 2, std::array{7.0f, infinity, 1.0f});
  choice.absorbed(view(), 4, std::array{infinity});
  EXPECT_EQ(script_.absorbed, (std::vector<std::pair<Block, float>>{
                                  {4, 0.5f}, {2, 7.0f}, {2, infinity}, {2, 1.0f}, {4, infinity}}));
}

TEST_F(BlockChoiceTest, RevisesWhoeverIsConcernedAndNoOneElse) {
  sample_all();
  oracle::Random random(2);
  for (std::size_t b = 0; b < 12; ++b) script_.priorities[b] = 1 + random.value();
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  std::vector<float> known = script_.priorities;  // what the queue has heard last
  std::size_t told_in_all = 0;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const bool always = random.below(3) == 0;
    script_.cares_below = random.below(4) == 0 ? infinity : 1;
    VisitPlan changed(12);
    for (std::size_t i = random.below(5); i > 0; --i) {
      const auto block = static_cast<Block>(random.below(12));
      if (!changed.contains(block)) changed.add({.block = block});
    }
    for (std::size_t b = 0; b < 12; ++b) {
      script_.priorities[b] = 1 + random.value();
      script_.news[b] = random.below(2) == 0;
    }
    script_.asked_for_news.clear();
    choice.revise(view(), changed, always);

    std::vector<float> expected = known;
    std::vector<Block> members;
    for (const Visit& visit : changed.visits()) members.push_back(visit.block);
    for (const Block block : members) expected[block] = script_.priorities[block];
    for (Block other = 0; other < 12; ++other) {
      bool told = false;
      for (const Block block : members) {
        const bool beside =
            (block / 3 == other / 3 && (block + 1 == other || other + 1 == block)) ||
            block + 3 == other || other + 3 == block;
        told = told || (beside && (always || script_.news[block]));
      }
      // One that hears of two neighbours may care no longer after the first: it knows all by then.
      if (told && !changed.contains(other) && known[other] < script_.cares_below) {
        expected[other] = script_.priorities[other];
        ++told_in_all;
      }
    }
    ASSERT_EQ(order(choice), sorted(expected)) << "repetition " << repetition;
    // A measure keeps track of what it told: every block is asked once, whether it matters or not.
    ASSERT_EQ(script_.asked_for_news, members);
    known = expected;
  }
  EXPECT_GT(told_in_all, 100u);
}

TEST_F(BlockChoiceTest, NoOneIsToldWithoutNews) {
  sample_all();
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  VisitPlan four(12);
  four.add({.block = 4});
  const auto asked = [&](bool always) {
    script_.asked.clear();
    choice.revise(view(), four, always);
    std::vector<Block> blocks;
    for (const auto& [block, factor] : script_.asked) blocks.push_back(block);
    std::sort(blocks.begin(), blocks.end());
    return blocks;
  };
  EXPECT_EQ(asked(false), std::vector<Block>{4});
  EXPECT_EQ(asked(true), (std::vector<Block>{1, 3, 4, 5, 7}));
  script_.news[4] = true;
  EXPECT_EQ(asked(false), (std::vector<Block>{1, 3, 4, 5, 7}));
  script_.cares_below = 0;
  EXPECT_EQ(asked(false), std::vector<Block>{4});
}

TEST_F(BlockChoiceTest, WhoCaresIsAskedWithItsPriority) {
  sample_all();
  for (std::size_t b = 0; b < 12; ++b) script_.priorities[b] = static_cast<float>(10 + b);
  Choice choice(ScriptedMeasure(script_), factors_);
  choice.revise_all(view());
  VisitPlan changed(12);
  changed.add({.block = 0});
  changed.add({.block = 1});  // does not hear of block 0 again
  script_.news[0] = true;
  script_.cares_below = 0;
  choice.revise(view(), changed, false);
  EXPECT_EQ(script_.asked_to_care, (std::multiset<float>{13}));
}

}  // namespace
}  // namespace freqsynth
