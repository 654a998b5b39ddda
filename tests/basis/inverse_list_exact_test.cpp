// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

/// J^-1 and its vectors, copied.
struct Entry {
  std::vector<double> inverse, gain, border;
  bool operator==(const Entry&) const = default;
};

std::vector<double> copy(std::span<const double> values) { return {values.begin(), values.end()}; }

Entry entry_of(const InverseList& list, std::size_t index) {
  return {copy(list.inverse(index)), copy(list.gain(index)), copy(list.border(index))};
}

/// Six chunks and a part of one.
constexpr std::size_t count = 400;

class ExactEntries : public testing::TestWithParam<InverseListSettings> {
 protected:
  /// Asked for one after the other.
  static std::vector<Entry> ascending() {
    const InverseList list(GetParam());
    std::vector<Entry> entries;
    for (std::size_t index = 0; index < count; ++index) entries.push_back(entry_of(list, index));
    return entries;
  }
  static std::vector<std::size_t> shuffled(unsigned seed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    oracle::Random random(seed);
    std::shuffle(order.begin(), order.end(), random.engine());
    return order;
  }
};
INSTANTIATE_TEST_SUITE_P(
    Lists, ExactEntries,
    testing::Values(InverseListSettings{}, InverseListSettings{.samples_per_term = 1, .seed = 3},
                    InverseListSettings{.samples_per_term = 3, .max_terms = 17}));

TEST_P(ExactEntries, AreTheSameInAnyOrder) {
  const auto expected = ascending();
  std::vector<std::vector<std::size_t>> orders = {shuffled(1), shuffled(2), shuffled(3)};
  orders.push_back(orders[0]);
  std::sort(orders[3].begin(), orders[3].end(), std::greater<>());
  // Around the ends of chunks, forth and back.
  orders.push_back({63, 64, 65, 63, 128, 127, 64, 0, 191, 192, 320, 193, 319, 1, 399, 62});
  for (const auto& order : orders) {
    const InverseList list(GetParam());
    for (const std::size_t index : order) {
      ASSERT_EQ(entry_of(list, index), expected[index]) << "index " << index;
    }
  }
}

TEST_P(ExactEntries, AreTheSameWhereverOneStarts) {
  const auto expected = ascending();
  for (const std::size_t first : {0u, 1u, 63u, 64u, 65u, 200u, 255u, 256u, 399u}) {
    const InverseList list(GetParam());
    list.reserve(count);
    ASSERT_EQ(entry_of(list, first), expected[first]) << "index " << first;
    for (const std::size_t index : {first / 2, first, std::min(first + 1, count - 1)}) {
      ASSERT_EQ(entry_of(list, index), expected[index]) << "index " << index << " after " << first;
    }
  }
}

TEST_P(ExactEntries, ItDoesNotMatterWhichOneIsAskedForFirst) {
  const auto expected = ascending();
  const InverseList list(GetParam());
  for (const std::size_t index : shuffled(4)) {
    switch (index % 3) {
      case 0:
        ASSERT_EQ(copy(list.gain(index)), expected[index].gain);
        break;
      case 1:
        ASSERT_EQ(copy(list.border(index)), expected[index].border);
        break;
      default:
        ASSERT_EQ(copy(list.inverse(index)), expected[index].inverse);
    }
    ASSERT_EQ(entry_of(list, index), expected[index]) << "index " << index;
  }
}

TEST_P(ExactEntries, AreTheSameFromSeveralThreads) {
  const auto expected = ascending();
  const InverseList list(GetParam());
  std::vector<std::size_t> wrong(4);
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
    threads.emplace_back([&, thread] {
      // The last one follows the list's growth, the others are all over it.
      const auto order = shuffled(10 + static_cast<unsigned>(thread));
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t index = thread + 1 == wrong.size() ? k : order[k];
        wrong[thread] += entry_of(list, index) == expected[index] ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::accumulate(wrong.begin(), wrong.end(), std::size_t{0}), 0u);
}

TEST_P(ExactEntries, SpansStayValid) {
  const InverseList list(GetParam());
  std::vector<std::pair<std::size_t, std::span<const double>>> spans;
  std::vector<std::vector<double>> copies;
  for (const std::size_t index : shuffled(5)) {
    for (const auto span : {list.inverse(index), list.gain(index), list.border(index)}) {
      spans.push_back({index, span});
      copies.push_back(copy(span));
    }
  }
  list.reserve(2000);
  static_cast<void>(list.inverse(1999));
  static_cast<void>(list.inverse(1000));
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const auto& [index, span] = spans[k];
    ASSERT_EQ(copy(span), copies[k]) << "index " << index;
    const auto again = k % 3 == 0   ? list.inverse(index)
                       : k % 3 == 1 ? list.gain(index)
                                    : list.border(index);
    ASSERT_EQ(again.data(), span.data()) << "index " << index;
    ASSERT_EQ(again.size(), span.size());
  }
}

}  // namespace
}  // namespace freqsynth
