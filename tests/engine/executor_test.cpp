// SPDX-License-Identifier: MIT
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/thread_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

static_assert(Executor<SerialExecutor>);
static_assert(Executor<ThreadPool>);
static_assert(!Executor<int>);

/// How often each index was run.
template <class E>
std::vector<int> runs_of(E& executor, std::size_t count) {
  std::vector<std::atomic<int>> runs(count);
  const auto task = [&](std::size_t index) { runs.at(index).fetch_add(1); };
  executor.execute(count, TaskRef(task));
  return {runs.begin(), runs.end()};
}

TEST(SerialExecutor, RunsEveryIndexOnceAndInOrder) {
  SerialExecutor executor;
  std::vector<std::size_t> order;
  auto task = [&](std::size_t index) { order.push_back(index); };
  executor.execute(5, TaskRef(task));
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  executor.execute(0, TaskRef(task));
  EXPECT_EQ(order.size(), 5u);
  EXPECT_EQ(executor.concurrency(), 1u);
}

TEST(ThreadPool, RunsEveryIndexOnceAndCanBeUsedAgain) {
  for (const std::size_t threads : {1u, 2u, 4u, 9u}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.concurrency(), threads);
    for (const std::size_t count : {0u, 1u, 2u, 3u, 17u, 1000u, 0u, 5u}) {
      ASSERT_THAT(runs_of(pool, count), Each(1)) << threads << " threads, " << count << " tasks";
    }
    for (int repetition = 0; repetition < 500; ++repetition) {
      ASSERT_THAT(runs_of(pool, 3), Each(1));
    }
  }
}

TEST(ThreadPool, WaitsForAllTasks) {
  ThreadPool pool(4);
  for (int repetition = 0; repetition < 200; ++repetition) {
    // Not atomic: only legal if execute() orders the tasks before its return.
    std::vector<std::size_t> results(16);
    const auto task = [&](std::size_t index) { results[index] = index; };
    pool.execute(results.size(), TaskRef(task));
    ASSERT_EQ(std::accumulate(results.begin(), results.end(), std::size_t{0}), 120u);
  }
}

TEST(ThreadPool, RunsAsManyTasksAtTheSameTimeAsItHasThreads) {
  constexpr std::size_t threads = 4;
  ThreadPool pool(threads);
  // Tasks that wait for one another: with fewer threads this would never end.
  std::barrier meeting(static_cast<std::ptrdiff_t>(threads));
  std::mutex mutex;
  std::set<std::thread::id> ids;
  const auto task = [&](std::size_t) {
    meeting.arrive_and_wait();
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  };
  pool.execute(threads, TaskRef(task));
  EXPECT_EQ(ids.size(), threads);
  EXPECT_EQ(ids.count(std::this_thread::get_id()), 1u) << "the caller works along";
}

TEST(ThreadPool, OneThreadIsTheCaller) {
  ThreadPool pool(1);
  std::vector<std::thread::id> ids;
  const auto task = [&](std::size_t) { ids.push_back(std::this_thread::get_id()); };
  pool.execute(10, TaskRef(task));
  EXPECT_THAT(ids, Each(std::this_thread::get_id()));
}

TEST(ThreadPool, ZeroThreadsIsOnePerHardwareThread) {
  const ThreadPool pool;
  EXPECT_EQ(pool.concurrency(), std::max(1u, std::thread::hardware_concurrency()));
}

TEST(ThreadPool, MayBeDestroyedUnused) {
  for (int repetition = 0; repetition < 50; ++repetition) ThreadPool pool(3);
}

TEST(ThreadPool, RefusesTooManyThreads) {
  EXPECT_THAT([] { ThreadPool pool(1025); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("threads"), HasSubstr("1025"))));
}

}  // namespace
}  // namespace freqsynth
