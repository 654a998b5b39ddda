// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_store.h"
#include "freqsynth/refine/least_squares_refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "support/oracles.h"
#include "support/refiner_helpers.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using helpers::ScriptedRefiner;
using helpers::shared_list;

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(BlockStore, CountsFollowATableThroughRandomSamples) {
  constexpr std::size_t blocks = 9, most = 12;
  BlockStore<ScriptedRefiner> store(ScriptedRefiner({1}), blocks, most);
  ASSERT_EQ(store.size(), blocks);
  EXPECT_EQ(store.most_samples(), most);
  std::vector<std::size_t> counts(blocks);
  oracle::Random random(1);
  for (std::size_t total = 0; total < blocks * most;) {
    std::size_t block = random.below(blocks);
    // One block is left alone for long.
    if (block == 4 && total < 60) block = 3;
    if (store.full(block)) continue;
    const float value = random.value();
    ASSERT_EQ(store.absorb(block, &value), value) << "what the refiner returns";
    ++counts[block];
    ++total;
    for (std::size_t b = 0; b < blocks; ++b) {
      ASSERT_EQ(store.samples(b), counts[b]);
      ASSERT_EQ(store.full(b), counts[b] == most);
      ASSERT_EQ(store.freedom(b), store.refiner().freedom(counts[b]));
    }
    ASSERT_EQ(store.largest(), *std::max_element(counts.begin(), counts.end()));
    ASSERT_EQ(store.untouched(),
              static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 0u)));
  }
}

TEST(BlockStore, StartsUntouched) {
  const BlockStore<ScriptedRefiner> store(ScriptedRefiner({1}), 5, 1);
  EXPECT_EQ(store.untouched(), 5u);
  EXPECT_EQ(store.largest(), 0u);
  EXPECT_FALSE(store.full(0));
  const BlockStore<ScriptedRefiner> none(ScriptedRefiner({1}), 0, 1);
  EXPECT_EQ(none.size(), 0u);
  EXPECT_EQ(none.untouched(), 0u);
}

/// A block that a refiner is fed with directly.
struct ByHand {
  explicit ByHand(const LeastSquaresRefiner& refiner) : state(refiner.state_size()) {
    refiner.reset(state.data());
  }
  detail::AlignedVector<float> state;
  std::size_t samples = 0;
};

void expect_same(const BlockStore<LeastSquaresRefiner>& store, std::size_t block,
                 const LeastSquaresRefiner& refiner, const ByHand& by_hand) {
  const float* state = by_hand.state.data();
  const std::size_t n = by_hand.samples;
  ASSERT_EQ(store.samples(block), n);
  ASSERT_EQ(store.freedom(block), refiner.freedom(n));
  ASSERT_EQ(store.residual(block), refiner.residual(state, n));
  for (std::size_t c = 0; c < refiner.channels(); ++c) {
    ASSERT_EQ(store.residual(block, c), refiner.residual(state, n, c));
    std::array<float, max_terms> found, expected;
    store.coefficients(block, c, found);
    refiner.coefficients(state, n, c, expected);
    ASSERT_EQ(found, expected);
    const BlockFit fit = store.fit(block, c);
    ASSERT_EQ(fit.coefficients, expected);
    ASSERT_EQ(fit.residual, refiner.residual(state, n, c));
    const auto sums = refiner.pixel_sums(state, c);
    ASSERT_TRUE(std::equal(sums.begin(), sums.end(), fit.pixel_sums.begin()));
  }
}

class Stores : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Channels, Stores, testing::Values(1, 3, 17));

TEST_P(Stores, BlocksAreThoseOfARefinerFedByHand) {
  const std::size_t channels = GetParam();
  constexpr std::size_t blocks = 7;
  const LeastSquaresRefiner refiner(shared_list(), channels);
  BlockStore<LeastSquaresRefiner> store(refiner, blocks, 1000);
  std::vector<ByHand> by_hand(blocks, ByHand(refiner));
  oracle::Random random(static_cast<unsigned>(channels));
  for (int n = 0; n < 600; ++n) {
    // Of different speeds, and the last one never has a sample.
    const std::size_t block = std::min(random.below(blocks - 1), random.below(blocks - 1));
    std::vector<float> values;
    for (std::size_t c = 0; c < channels; ++c) values.push_back(random.value());
    ByHand& own = by_hand[block];
    store.prefetch(block, own.samples, 1);
    const float change = refiner.absorb(own.state.data(), own.samples++, values.data());
    ASSERT_EQ(store.absorb(block, values.data()), change);
    ASSERT_NO_FATAL_FAILURE(expect_same(store, block, refiner, own));
  }
  for (std::size_t block = 0; block < blocks; ++block) {
    ASSERT_NO_FATAL_FAILURE(expect_same(store, block, refiner, by_hand[block]));
  }
}

TEST(BlockStore, TellsWhichChannelsHadValuesBelowZero) {
  BlockStore<LeastSquaresRefiner> store(LeastSquaresRefiner(shared_list(), 4), 2, 1000);
  for (const std::array<float, 4>& values :
       {std::array<float, 4>{0, 1, -infinity, 2}, {-0.0f, 3, 1, 0}, {1, -1e-30f, 1, 0}}) {
    store.absorb(1, values.data());
  }
  EXPECT_FALSE(store.any_negative(0));
  EXPECT_TRUE(store.any_negative(1));
  EXPECT_FALSE(store.any_negative(2)) << "a value that is not usable is none";
  EXPECT_FALSE(store.any_negative(3));
}

TEST(BlockStore, SeveralSamplesAtOnceAreTheSameOneAfterTheOther) {
  constexpr std::size_t channels = 3, blocks = 4, most = 400;
  const LeastSquaresRefiner refiner(shared_list(), channels);
  BlockStore<LeastSquaresRefiner> one(refiner, blocks, most), several(refiner, blocks, most);
  constexpr std::array exponents{2, 0, -5};
  constexpr std::array weights{0.5f, 0.25f, 0.25f};
  one.use_units(exponents, weights);
  several.use_units(exponents, weights);
  for (BlockStore<LeastSquaresRefiner>* store : {&one, &several}) {
    store->reserve(blocks * most);
  }
  oracle::Random random(5);
  for (std::size_t block = 0; block < blocks; ++block) {
    while (!one.full(block)) {
      const std::size_t count = std::min(random.below(40), most - one.samples(block));
      std::vector<float> values;
      for (std::size_t i = 0; i < channels * count; ++i) values.push_back(random.value() - 0.5f);
      // Block 1 has bad values all the time, block 2 a single one.
      if (count > 0 && block == 1) values[random.below(values.size())] = infinity;
      if (block == 2 && one.samples(block) > 200 && !one.has_gaps(2, 1) && count > 0) {
        values[1] = infinity;
      }
      std::vector<float> changes(count);
      several.absorb(block, changes, [&](std::size_t i) { return values.data() + channels * i; });
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(one.absorb(block, values.data() + channels * i), changes[i]);
      }
      ASSERT_EQ(one.samples(block), several.samples(block));
      ASSERT_EQ(one.informed(block), several.informed(block));
    }
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<Gap> gaps, other_gaps;
      const BlockFit fit = one.fit_without_gaps(block, c, gaps);
      const BlockFit other = several.fit_without_gaps(block, c, other_gaps);
      EXPECT_EQ(fit.coefficients, other.coefficients);
      EXPECT_EQ(fit.residual, other.residual);
      EXPECT_EQ(fit.spread, other.spread);
      EXPECT_EQ(gaps.size(), other_gaps.size());
      EXPECT_TRUE(
          std::equal(fit.pixel_sums.begin(), fit.pixel_sums.end(), other.pixel_sums.begin()));
    }
  }
  EXPECT_EQ(several.largest(), most);
  EXPECT_EQ(several.untouched(), 0u);
  EXPECT_TRUE(several.any_negative(0));
}

}  // namespace
}  // namespace freqsynth
