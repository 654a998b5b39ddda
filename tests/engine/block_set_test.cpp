// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

TEST(BlockSet, FollowsAListThroughRandomChanges) {
  constexpr std::size_t blocks = 40;
  BlockSet set(blocks);
  std::vector<std::uint32_t> expected;
  oracle::Random random(1);
  for (int operation = 0; operation < 3000; ++operation) {
    if (random.below(100) == 0) {
      set.clear();
      expected.clear();
    } else {
      const auto block = static_cast<std::uint32_t>(random.below(blocks));
      set.add(block);
      if (std::find(expected.begin(), expected.end(), block) == expected.end()) {
        expected.push_back(block);
      }
    }
    ASSERT_EQ(std::vector(set.members().begin(), set.members().end()), expected);
    for (std::uint32_t block = 0; block < blocks; ++block) {
      ASSERT_EQ(set.contains(block),
                std::find(expected.begin(), expected.end(), block) != expected.end());
    }
  }
}

TEST(BlockSet, MemoryStaysWhereItIs) {
  BlockSet set(100);
  set.add(5);
  const std::uint32_t* const members = set.members().data();
  for (int repetition = 0; repetition < 3; ++repetition) {
    for (std::uint32_t block = 0; block < 100; ++block) set.add(99 - block);
    EXPECT_EQ(set.members().size(), 100u);
    EXPECT_EQ(set.members().data(), members);
    set.clear();
  }
}

TEST(BlockSet, MayBeOfNoBlocks) {
  BlockSet set(0);
  set.clear();
  EXPECT_TRUE(set.members().empty());
}

}  // namespace
}  // namespace freqsynth
