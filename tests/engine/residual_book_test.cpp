// SPDX-License-Identifier: MIT
#include "freqsynth/engine/residual_book.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "freqsynth/engine/block_measure.h"
#include "support/block_image.h"
#include "support/oracles.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using Block = helpers::BlockNumber;
using helpers::BlockImage;
using helpers::feed;
using helpers::ScriptedRefiner;
using helpers::tolerance;
using oracle::Real;

TEST(ResidualBook, KeepsTheNewestResidualsAndTheirMean) {
  BlockImage<ScriptedRefiner> image(3, 3, ScriptedRefiner({0.5f, 2}));
  ResidualBook book(9);
  EXPECT_EQ(book.mean(), 0);
  oracle::Random random(1);
  const auto check = [&](Block block) {
    book.note(block, plausible_residual(image.view(), block));
    Real sum = 0;
    for (Block b = 0; b < 9; ++b) {
      ASSERT_EQ(book.of(b), image.blocks.residual(b));
      sum += static_cast<Real>(image.blocks.residual(b));
    }
    ASSERT_NEAR(book.mean(), static_cast<double>(sum / 9), tolerance(sum / 9));
  };
  feed(image, 400, random, check);
}

TEST(ResidualBook, AFactorOfOneChangesNotABit) {
  // A sum that is added up anew would not have lost what the great number took away.
  ResidualBook book(2);
  book.note(0, 1e30f);
  book.note(1, 1);
  book.note(0, 0.25f);
  const float mean = book.mean();
  book.rescale(1);
  EXPECT_EQ(book.mean(), mean);
}

TEST(ResidualBook, PoolsAWeightedMeanOfVariances) {
  for (const auto& [x, y] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 4}, {4, 1}, {3, 3}}) {
    BlockImage<ScriptedRefiner> image(x, y, ScriptedRefiner({1}));
    ResidualBook book(x * y);
    oracle::Random random(static_cast<unsigned>(x));
    feed(image, 100, random,
         [&](Block block) { book.note(block, plausible_residual(image.view(), block)); });
    std::vector<float> some(x * y);  // of whatever the caller pools
    for (float& value : some) value = static_cast<float>(random.uniform(0, 5));
    for (Block block = 0; block < x * y; ++block) {
      for (const float neighbours : {0.0f, 16.0f, 1000.0f}) {
        for (const float whole : {0.0f, 1.0f, 77.0f}) {
          const auto own = static_cast<Real>(image.blocks.freedom(block));
          Real sum = own * static_cast<Real>(some[block]), weight = own;
          const auto beside = image.beside(block);
          for (const Block other : beside) {
            const Real share = static_cast<Real>(neighbours) / static_cast<Real>(beside.size());
            sum += share * static_cast<Real>(some[other]);
            weight += share;
          }
          sum += static_cast<Real>(whole) * static_cast<Real>(book.mean());
          weight += static_cast<Real>(whole);
          const float pooled = book.pooled(
              image.view(), block, [&](Block b) { return some[b]; }, neighbours, whole);
          ASSERT_NEAR(pooled, static_cast<double>(sum / weight), tolerance(sum / weight))
              << x << " x " << y << " blocks, block " << block;
        }
      }
    }
  }
}

TEST(ResidualBook, NewsAreResidualsThatHaveGrownByAQuarter) {
  BlockImage<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}), 1000);
  ResidualBook book(2);
  const auto news_after = [&](float residual) {
    image.blocks.absorb(1, &residual);
    book.note(1, plausible_residual(image.view(), 1));
    return book.has_news(1);
  };
  EXPECT_FALSE(book.has_news(1)) << "nothing there";
  EXPECT_FALSE(news_after(0));
  EXPECT_TRUE(news_after(1));
  EXPECT_FALSE(book.has_news(1)) << "told already";
  EXPECT_FALSE(news_after(1.25f));
  EXPECT_TRUE(news_after(1.26f));
  EXPECT_FALSE(news_after(1.5f)) << "over what was told last, not over what was first";
  EXPECT_FALSE(news_after(0.64f));
  EXPECT_FALSE(news_after(1.57f)) << "half or more was no loss to speak of";
  EXPECT_FALSE(news_after(0.62f)) << "less is not told";
  EXPECT_TRUE(news_after(0.78f)) << "but what grows from there is";
  EXPECT_FALSE(book.has_news(0)) << "of others nothing is known";
}

}  // namespace
}  // namespace freqsynth
