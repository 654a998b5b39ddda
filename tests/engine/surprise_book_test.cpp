// SPDX-License-Identifier: MIT
#include "freqsynth/engine/surprise_book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

/// All that has happened, and what is to be made of it.
struct Events {
  struct Event {
    std::size_t level;
    double square;
  };
  std::vector<Event> surprises;
  std::vector<std::size_t> samples;  // levels of

  double expected(std::size_t now) const {
    const std::size_t level = std::bit_width(now) - 1u;
    std::vector<double> squares;
    double count = 0, sum = 0;
    for (const Event& event : surprises) {
      if (event.level == level || event.level + 1 == level) squares.push_back(event.square);
    }
    for (const std::size_t each : samples) count += each == level || each + 1 == level ? 1 : 0;
    std::sort(squares.rbegin(), squares.rend());
    if (!squares.empty()) squares[0] = squares.size() > 1 ? squares[1] : 0;
    for (const double square : squares) sum += square;
    return count > 0 ? sum / count : 0;
  }
};

TEST(SurpriseBook, IsTheMeanSquareOfLatelySeenSurprises) {
  SurpriseBook book(2);
  Events all[2];
  oracle::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const std::size_t before = 8 + random.below(500);
    book.count(before, 1);
    const std::size_t level = std::bit_width(before) - 1u;
    for (Events& events : all) events.samples.push_back(level);
    if (random.below(20) > 0) continue;
    const std::size_t channel = random.below(2);
    const auto square = static_cast<float>(1 + random.below(100));
    // A flat block, of which the fit has taken in half of the square.
    book.note(channel, {before, 0, 1}, {2 * before, square, static_cast<float>(before)});
    all[channel].surprises.push_back({level, 2 * double{square}});
  }
  for (const std::size_t samples : {16u, 40u, 100u, 300u, 511u, 600u}) {
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_NEAR(book.expected(c, samples), all[c].expected(samples), 1e-9) << samples;
    }
  }
}

TEST(SurpriseBook, IgnoresFewSamplesWhatIsUsualAndASingleOne) {
  SurpriseBook book(1);
  for (int i = 0; i < 100; ++i) book.count(20, 1);
  book.note(0, {4, 0, 2}, {5, 9, 3});
  book.note(0, {7, 0, 2}, {8, 9, 3});
  EXPECT_EQ(book.expected(0, 7), 0);
  EXPECT_EQ(book.expected(0, 8), 0);
  book.note(0, {20, 1, 10}, {21, 9, 10});
  book.note(0, {20, 1, 10}, {21, 9, 10});
  EXPECT_EQ(book.expected(0, 20), 0) << "nine times as much";
  book.note(0, {20, 0, 10}, {21, 9, 10});
  EXPECT_EQ(book.expected(0, 20), 0) << "a single one";
  book.note(0, {20, 1, 10}, {21, 11, 10});
  // Squares of 18.9 and 21.
  EXPECT_DOUBLE_EQ(book.expected(0, 20), 2 * 18.9 / 100) << "the greater counts as the other";
}

TEST(SurpriseBook, FollowsTheUnits) {
  SurpriseBook book(2);
  book.count(30, 50);
  for (std::size_t c = 0; c < 2; ++c) {
    for (const float square : {3.0f, 5.0f, 8.0f}) book.note(c, {30, 0, 20}, {31, square, 20});
  }
  const double before = book.expected(1, 30);
  book.rescale(1, -3);
  EXPECT_DOUBLE_EQ(book.expected(1, 30), before / 64);
  EXPECT_DOUBLE_EQ(book.expected(0, 30), before);
}

TEST(SurpriseBook, OfAStoreCountsTheBlocksThatSawADot) {
  const SharedInverseList list = helpers::shared_list();
  constexpr std::size_t blocks = 40, samples = 30;
  BlockStore<LeastSquaresRefiner> store(LeastSquaresRefiner(list, 1), blocks, 100);
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t i = 0; i < samples; ++i) {
      // Every tenth block has one sample that is not like the others.
      const float value = block % 10 == 0 && i == 20 ? 2.0f : 1.0f;
      store.absorb(block, &value);
    }
  }
  // 4 blocks of 40 by 1, in the 22 samples from the 9th on.
  const double rate = 4.0 / (40.0 * 22);
  EXPECT_GT(store.surprises().expected(0, samples), 0.5 * rate);
  EXPECT_LT(store.surprises().expected(0, samples), 2 * rate);
  // As in other units, and then nothing of it at all when nothing is seen any more.
  store.use_units(std::vector{4}, std::vector{1.0f});
  EXPECT_GT(store.surprises().expected(0, samples) * 256, 0.5 * rate);
  EXPECT_EQ(store.surprises().expected(0, 100), 0);
}

}  // namespace
}  // namespace freqsynth
