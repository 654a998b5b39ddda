// SPDX-License-Identifier: MIT
#include "freqsynth/image/frequency_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <utility>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/reconstructor.h"

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(FrequencyImage, HasOneBlockPerStartedEightPixels) {
  for (const auto& [pixels, blocks] :
       {std::pair<std::size_t, std::size_t>{1, 1}, {7, 1}, {8, 1}, {9, 2}, {16, 2}, {257, 33}}) {
    const FrequencyImage image(pixels, 20, 2);
    EXPECT_EQ(image.width(), pixels);
    EXPECT_EQ(image.height(), 20u);
    EXPECT_EQ(image.channels(), 2u);
    EXPECT_EQ(image.blocks_x(), blocks);
    EXPECT_EQ(image.blocks_y(), 3u);
  }
}

TEST(FrequencyImage, StartsAtZero) {
  const FrequencyImage image(17, 9, 3);
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      EXPECT_EQ(image.samples(x, y), 0u);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_THAT(image.coefficients(x, y, c), Each(0.0f));
    }
  }
}

TEST(FrequencyImage, KeepsEveryNumberApart) {
  FrequencyImage image(17, 9, 3);
  float next = 0;
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      image.samples(x, y) = static_cast<std::uint32_t>(100 * y + x);
      for (std::size_t c = 0; c < 3; ++c) {
        for (float& value : image.coefficients(x, y, c)) value = next++;
      }
    }
  }
  const FrequencyImage& constant = image;
  std::set<float> seen;
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      EXPECT_EQ(constant.samples(x, y), 100 * y + x);
      for (std::size_t c = 0; c < 3; ++c) {
        for (const float value : constant.coefficients(x, y, c)) seen.insert(value);
      }
    }
  }
  EXPECT_EQ(seen.size(), 2 * 3 * 3 * max_terms);
}

TEST(FrequencyImage, SaysWhatItsCoefficientsMean) {
  EXPECT_EQ(FrequencyImage(8, 8, 1).meaning(), CoefficientMeaning::point_function);
  EXPECT_EQ(FrequencyImage(8, 8, 1, CoefficientMeaning::pixel_average).meaning(),
            CoefficientMeaning::pixel_average);
}

TEST(FrequencyImage, MayBeEmpty) {
  EXPECT_EQ(FrequencyImage().blocks_x(), 0u);
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{0, 0}, {0, 5}, {5, 0}}) {
    const FrequencyImage image(width, height, 3);
    EXPECT_EQ(image.width(), width);
    EXPECT_EQ(image.height(), height);
    EXPECT_EQ(image.blocks_x() * image.blocks_y(), 0u);
  }
}

TEST(FrequencyImage, IsEmptyWhenMovedFrom) {
  FrequencyImage image(17, 9, 3);
  image.coefficients(2, 1, 2)[63] = 7;
  image.samples(2, 1) = 5;
  image.set_non_negative(1, true);
  FrequencyImage taken(std::move(image));
  EXPECT_EQ(taken.coefficients(2, 1, 2)[63], 7);
  EXPECT_EQ(taken.samples(2, 1), 5u);
  FrequencyImage assigned(8, 8, 1);
  assigned = std::move(taken);
  EXPECT_EQ(assigned.width(), 17u);
  EXPECT_FALSE(assigned.non_negative(0));
  EXPECT_TRUE(assigned.non_negative(1));
  EXPECT_EQ(assigned.coefficients(2, 1, 2)[63], 7);
  // What is left can be used like any image without pixels.
  for (const FrequencyImage* left : {&image, &taken}) {
    EXPECT_EQ(left->width(), 0u);
    EXPECT_EQ(left->blocks_x(), 0u);
    EXPECT_EQ(left->blocks_y(), 0u);
    EXPECT_TRUE(reconstruct(*left).empty());
  }
  FrequencyImage& itself = assigned;
  assigned = std::move(itself);
  EXPECT_EQ(assigned.coefficients(2, 1, 2)[63], 7);
}

TEST(FrequencyImage, SizesThatOverflowAreRefused) {
  constexpr std::size_t huge = std::numeric_limits<std::size_t>::max();
  const auto refuses = [](std::size_t width, std::size_t height, std::size_t channels) {
    const auto message = ThrowsMessage<std::invalid_argument>(
        AllOf(HasSubstr(std::to_string(width)), HasSubstr(std::to_string(height)),
              HasSubstr(std::to_string(channels))));
    EXPECT_THAT([&] { FrequencyImage(width, height, channels); }, message);
    EXPECT_THAT([&] { BlockGrid::of(width, height, channels); }, message);
  };
  refuses(huge, huge, 1);
  refuses(huge, 1, 1);
  refuses(1, huge, 1);
  refuses(8, 8, huge);
  refuses(8, 8, huge / 64);
  refuses(8, 8, 0);
  refuses(0, 0, 0);
  // 2^32 blocks.
  refuses(std::size_t{1} << 19, std::size_t{1} << 19, 1);
}

TEST(BlockGrid, AllowsTheLargestSizes) {
  // 2^32 - 2 blocks = 2 x 2147483647; only counted, not allocated.
  const BlockGrid grid = BlockGrid::of(16, std::size_t{2147483647} * 8, 1);
  EXPECT_EQ(grid.blocks_x, 2u);
  EXPECT_EQ(grid.blocks_y, 2147483647u);
  EXPECT_THROW(BlockGrid::of(8, std::size_t{4294967295} * 8, 1), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
