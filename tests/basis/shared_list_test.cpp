// SPDX-License-Identifier: MIT
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/basis/inverse_list.h"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace freqsynth {
namespace {

// A list or two too many, or one too few, is seen by the sanitizers that these tests run under.

static_assert(std::is_nothrow_move_constructible_v<SharedInverseList>);
static_assert(std::is_nothrow_copy_constructible_v<SharedInverseList>);
static_assert(!std::is_convertible_v<SharedInverseList, bool>);

InverseListSettings with_seed(std::uint64_t seed) {
  InverseListSettings settings;
  settings.seed = seed;
  return settings;
}

TEST(SharedInverseList, MayBeNone) {
  const SharedInverseList none, other;
  EXPECT_FALSE(none);
  EXPECT_TRUE(none == other);
  const SharedInverseList copy(none);
  EXPECT_FALSE(copy);
}

TEST(SharedInverseList, IsAListOfTheSettings) {
  const SharedInverseList list(with_seed(7));
  ASSERT_TRUE(list);
  EXPECT_EQ(list->settings().seed, 7u);
  EXPECT_EQ((*list).settings().seed, 7u);
  EXPECT_EQ(&*list, list.operator->());
  EXPECT_EQ(list->size(), 0u);
  InverseListSettings wrong;
  wrong.samples_per_term = 0;
  EXPECT_THROW(SharedInverseList{wrong}, std::invalid_argument);
}

TEST(SharedInverseList, CopiesReferToTheSameList) {
  const SharedInverseList list(with_seed(1));
  const SharedInverseList copy(list);
  SharedInverseList assigned;
  assigned = copy;
  EXPECT_EQ(&*copy, &*list);
  EXPECT_EQ(&*assigned, &*list);
  copy->reserve(50);
  EXPECT_EQ(list->size(), 50u);
  EXPECT_TRUE(list);
}

TEST(SharedInverseList, EqualityIsIdentity) {
  const SharedInverseList first(with_seed(1)), second(with_seed(1)), none;
  const SharedInverseList copy(first);
  EXPECT_TRUE(first == copy);
  EXPECT_FALSE(first == second) << "two lists, though of equal content";
  EXPECT_TRUE(first != second);
  EXPECT_FALSE(first == none);
  EXPECT_FALSE(none == first);
}

TEST(SharedInverseList, MovesLeaveNone) {
  SharedInverseList list(with_seed(2));
  const InverseList* const address = &*list;
  SharedInverseList moved(std::move(list));
  EXPECT_FALSE(list);
  EXPECT_EQ(&*moved, address);
  SharedInverseList assigned(with_seed(3));  // whose list goes
  assigned = std::move(moved);
  EXPECT_FALSE(moved);
  EXPECT_EQ(&*assigned, address);
  EXPECT_EQ(assigned->settings().seed, 2u);
  // What was moved from can be used again.
  moved = assigned;
  EXPECT_EQ(&*moved, address);
}

TEST(SharedInverseList, MayBeAssignedToItself) {
  SharedInverseList list(with_seed(4)), none;
  SharedInverseList& itself = list;
  const InverseList* const address = &*list;
  list = itself;
  ASSERT_TRUE(list);
  EXPECT_EQ(&*list, address);
  list = std::move(itself);
  ASSERT_TRUE(list);
  EXPECT_EQ(&*list, address);
  EXPECT_EQ(list->settings().seed, 4u);
  SharedInverseList& also_none = none;
  none = also_none;
  EXPECT_FALSE(none);
}

TEST(SharedInverseList, LivesAsLongAsTheLastReference) {
  std::optional<SharedInverseList> original(with_seed(5));
  (*original)->reserve(100);
  std::vector<SharedInverseList> copies(10, *original);
  const float* const gain = copies[0]->row(99).gain;
  const float first = *gain;
  original.reset();
  for (std::size_t i = 0; i + 1 < copies.size(); ++i) {
    copies[i] = i % 2 == 0 ? SharedInverseList() : SharedInverseList(with_seed(6));
  }
  EXPECT_EQ(copies.back()->size(), 100u);
  EXPECT_EQ(copies.back()->row(99).gain, gain);
  EXPECT_EQ(*gain, first);
}

TEST(SharedInverseList, CopiesMayComeAndGoInSeveralThreads) {
  SharedInverseList list(with_seed(8));
  const InverseList* const address = &*list;
  std::vector<std::size_t> wrong(4);
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
    threads.emplace_back([&wrong, address, thread, own = list]() mutable {
      for (std::size_t n = 0; n < 2000; ++n) {
        SharedInverseList copy(own);
        SharedInverseList other;
        other = copy;
        copy = SharedInverseList();
        own = std::move(other);
        wrong[thread] += &*own == address ? 0 : 1;
        wrong[thread] += own->terms(n % 130) >= 1 ? 0 : 1;
      }
    });
  }
  // The threads' copies are what is left.
  list = SharedInverseList();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::accumulate(wrong.begin(), wrong.end(), std::size_t{0}), 0u);
}

}  // namespace
}  // namespace freqsynth
