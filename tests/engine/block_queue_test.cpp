// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

/// The paper's list: sorted by priority, then by number.
std::vector<std::size_t> sorted_blocks(const std::vector<float>& priorities) {
  std::vector<std::size_t> order(priorities.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return priorities[a] > priorities[b]; });
  return order;
}

void expect_same(const BlockQueue& queue, const std::vector<float>& priorities) {
  const std::size_t first = sorted_blocks(priorities).front();
  ASSERT_EQ(queue.top_priority(), priorities[first]);
  if (priorities[first] != BlockQueue::absent) {
    ASSERT_EQ(queue.top(), first);
  }
}

class BlockQueueOfSize : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Sizes, BlockQueueOfSize,
                         testing::Values(1, 2, 7, 8, 9, 63, 64, 65, 512, 513, 1000));

TEST_P(BlockQueueOfSize, FollowsTheSortedListThroughRandomChanges) {
  const std::size_t size = GetParam();
  BlockQueue queue(size);
  std::vector<float> priorities(size, BlockQueue::absent);
  ASSERT_EQ(queue.size(), size);
  ASSERT_EQ(queue.top_priority(), BlockQueue::absent);
  oracle::Random random(static_cast<unsigned>(size));
  const std::vector<float> ties = {
      0, 0.5f, 1, 2, -1, BlockQueue::absent, std::numeric_limits<float>::infinity()};
  for (int operation = 0; operation < 2000; ++operation) {
    const std::size_t block = random.below(size);
    const float priority = random.below(2) == 0 ? ties[random.below(ties.size())] : random.value();
    queue.update(block, priority);
    priorities[block] = priority;
    ASSERT_EQ(queue.priority(block), priority);
    ASSERT_NO_FATAL_FAILURE(expect_same(queue, priorities));
  }
  for (std::size_t block = 0; block < size; ++block) {
    ASSERT_EQ(queue.priority(block), priorities[block]);
  }
}

TEST_P(BlockQueueOfSize, GrowsAndKeepsWhatItHad) {
  BlockQueue queue(1);
  std::vector<float> priorities(1, BlockQueue::absent);
  oracle::Random random(static_cast<unsigned>(GetParam()));
  while (priorities.size() < GetParam()) {
    priorities.resize(std::min(GetParam(), priorities.size() + 1 + random.below(9)),
                      BlockQueue::absent);
    queue.grow(priorities.size());
    ASSERT_EQ(queue.size(), priorities.size());
    const std::size_t block = random.below(priorities.size());
    queue.update(block, priorities[block] = random.value());
    ASSERT_NO_FATAL_FAILURE(expect_same(queue, priorities));
    for (std::size_t i = 0; i < priorities.size(); ++i) {
      ASSERT_EQ(queue.priority(i), priorities[i]);
    }
  }
}

TEST_P(BlockQueueOfSize, TakesAllBlocksInOrder) {
  const std::size_t size = GetParam();
  BlockQueue queue(size);
  std::vector<float> priorities(size);
  oracle::Random random(static_cast<unsigned>(size) + 1);
  for (std::size_t block = 0; block < size; ++block) {
    priorities[block] = static_cast<float>(random.below(5));
    queue.update(block, priorities[block]);
  }
  for (const std::size_t block : sorted_blocks(priorities)) {
    ASSERT_EQ(queue.top(), block);
    ASSERT_EQ(queue.top_priority(), priorities[block]);
    queue.update(block, BlockQueue::absent);
  }
  EXPECT_EQ(queue.top_priority(), BlockQueue::absent);
}

TEST(BlockQueue, AmongEqualsTheLowestNumberIsFirst) {
  BlockQueue queue(200);
  for (const std::size_t block : {150u, 70u, 199u, 64u, 63u, 8u, 7u}) {
    queue.update(block, 3);
    // They arrive in decreasing order except 199.
    EXPECT_EQ(queue.top(), block == 199 ? 70u : block);
  }
  queue.update(0, 3);
  EXPECT_EQ(queue.top(), 0u);
}

TEST(BlockQueue, MayBeEmpty) {
  const BlockQueue queue;
  EXPECT_EQ(queue.size(), 0u);
  EXPECT_EQ(queue.top_priority(), BlockQueue::absent);
}

}  // namespace
}  // namespace freqsynth
