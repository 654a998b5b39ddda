// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

#include "freqsynth/basis/inverse_list.h"

namespace freqsynth {
namespace {

bool same(std::span<const double> a, std::span<const double> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

bool same_entry(const InverseList& a, const InverseList& b, std::size_t index) {
  return a.position(index).s == b.position(index).s && a.position(index).t == b.position(index).t &&
         a.terms(index) == b.terms(index) && same(a.inverse(index), b.inverse(index)) &&
         same(a.gain(index), b.gain(index)) && same(a.border(index), b.border(index)) &&
         std::equal(a.row(index).gain, a.row(index).gain + max_terms, b.row(index).gain);
}

TEST(InverseListGrowth, GrowsAlikeInOneStepAndInMany) {
  const InverseList at_once, stepwise;
  EXPECT_EQ(at_once.size(), 0u);
  at_once.reserve(300);
  EXPECT_EQ(at_once.size(), 300u);
  at_once.reserve(10);
  EXPECT_EQ(at_once.size(), 300u);
  for (std::size_t index = 0; index < 300; ++index) {
    ASSERT_TRUE(same_entry(stepwise, at_once, index)) << "index " << index;
    ASSERT_EQ(stepwise.size(), index + 1);
  }
}

TEST(InverseListGrowth, GrowsAlikeFromSeveralThreads) {
  const InverseList reference;
  reference.reserve(700);
  const InverseList shared;
  // Each reader walks in jumps of its own, so that it meets entries that others are building.
  std::vector<std::size_t> wrong(4);
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
    threads.emplace_back([&, thread] {
      for (std::size_t index = thread; index < 700; index += 1 + (index * 7 + thread) % 5) {
        wrong[thread] += same_entry(shared, reference, index) ? 0 : 1;
        wrong[thread] += same_entry(shared, reference, index / 2) ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::accumulate(wrong.begin(), wrong.end(), std::size_t{0}), 0u);
}

TEST(InverseListGrowth, EntriesAreNeverMoved) {
  const InverseList list;
  const auto* row = &list.row(3);
  const double* inverse = list.inverse(3).data();
  list.reserve(1000);
  EXPECT_EQ(&list.row(3), row);
  EXPECT_EQ(list.inverse(3).data(), inverse);
}

}  // namespace
}  // namespace freqsynth
