// SPDX-License-Identifier: MIT
#include "freqsynth/engine/pixel_counts.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

TEST(PixelCounts, PixelsContainTheirPoints) {
  const BlockGrid grid = BlockGrid::of(20, 11, 1);
  const PixelCounts counts(grid);
  EXPECT_EQ(counts.pixel({0, 0}), 0u);
  EXPECT_EQ(counts.pixel({0.999, 0.999}), 0u);
  EXPECT_EQ(counts.pixel({1, 0.5}), 1u);
  EXPECT_EQ(counts.pixel({8, 8}), 8u * 20 + 8);
  EXPECT_EQ(counts.pixel({19.5, 2}), 2u * 20 + 19);
  EXPECT_EQ(counts.pixel({20, 2}), 2u * 20 + 19) << "the border belongs to the last pixel";
  EXPECT_EQ(counts.pixel({3, 11}), 10u * 20 + 3);
  EXPECT_EQ(counts.pixel({20, 11}), 11u * 20 - 1);
}

TEST(PixelCounts, CountBeyondTwoBytes) {
  oracle::Random random(1);
  PixelCounts counts(BlockGrid::of(3, 2, 1));
  std::vector<std::uint32_t> expected(6);
  for (int portion = 0; portion < 700; ++portion) {
    const std::size_t size = random.below(300);
    counts.reserve(size);
    for (std::size_t i = 0; i < size; ++i) {
      // The fourth has most of them.
      const std::size_t pixel = random.below(8) == 0 ? random.below(6) : 3;
      ASSERT_EQ(counts.next(pixel), expected[pixel]++);
    }
  }
  EXPECT_GT(expected[3], 70000u);
  EXPECT_LT(expected[2], 65536u);
}

TEST(PixelCounts, MayBeReservedForMoreThanTwoBytesAtOnce) {
  PixelCounts counts(BlockGrid::of(1, 1, 1));
  counts.reserve(100000);
  for (std::uint32_t i = 0; i < 100000; ++i) ASSERT_EQ(counts.next(0), i);
}

}  // namespace
}  // namespace freqsynth
