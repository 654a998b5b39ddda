// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

// The sanitizers need more address space than the test leaves.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FREQSYNTH_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FREQSYNTH_TEST_SANITIZED 1
#endif
#endif

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

#if !defined(FREQSYNTH_TEST_SANITIZED)
/// Ends the process with 0 when a pool of too many threads is refused, and a smaller one works.
[[noreturn]] void ask_for_too_many_threads() {
  // Each thread takes 8 MB of address space for its stack, and there is room for a few dozen.
  const rlimit limit{400'000'000, 400'000'000};
  if (setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(3);
  alarm(60);  // rather than hanging for ever
  try {
    const ThreadPool pool(1024);
    std::_Exit(2);
  } catch (const std::system_error&) {
  }
  ThreadPool pool(2);
  std::atomic<int> sum = 0;
  const auto task = [&](std::size_t i) { sum += static_cast<int>(i); };
  pool.execute(10, TaskRef(task));
  std::_Exit(sum == 45 ? 0 : 4);
}
#endif

TEST(ThreadPoolFaults, ThreadsThatCannotBeStartedAreAnError) {
#if defined(FREQSYNTH_TEST_SANITIZED)
  GTEST_SKIP() << "sanitizers need the address space";
#else
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(ask_for_too_many_threads(), testing::ExitedWithCode(0), "");
#endif
}

TEST(ThreadPoolFaults, ASamplerMayUseThePoolItself) {
  // A sampler that renders an image of its own for every 50th sample, on the same threads.
  Synthesizer straight(settings_of(40, 32)), engine(settings_of(40, 32));
  straight.run(picture, at_samples(400));
  ThreadPool pool(3);
  std::atomic<int> inner_images = 0;
  const auto sampler = [&](const Request& request) {
    if (request.id % 50 == 0) {
      Synthesizer inner(settings_of(16, 16));
      inner.run(picture, at_samples(50), pool);
      inner_images += inner.stats().samples == 50 ? 1 : 0;
    }
    return picture(request.x, request.y);
  };
  engine.run(sampler, at_samples(400), pool);
  EXPECT_GT(inner_images, 0);
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(ThreadPoolFaults, SeveralThreadsMayShareAPool) {
  ThreadPool pool(3);
  Synthesizer straight(settings_of(40, 32));
  straight.run(picture, at_samples(600));
  std::vector<std::thread> callers;
  std::atomic<int> right = 0;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&] {
      Synthesizer engine(settings_of(40, 32));
      engine.run(picture, at_samples(600), pool, KeepGoing{}, 20);
      right += helpers::same_image(engine.image(), straight.image()) ? 1 : 0;
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(right, 4);
}

TEST(ThreadPoolFaults, ATaskThatThrowsIsToldWhenAllAreDone) {
  ThreadPool pool(3);
  for (std::size_t fatal = 0; fatal < 8; ++fatal) {
    std::atomic<int> done = 0;
    const auto task = [&](std::size_t i) {
      ++done;
      if (i == fatal) throw std::runtime_error("task");
    };
    EXPECT_THROW(pool.execute(8, TaskRef(task)), std::runtime_error);
    EXPECT_EQ(done, 8);
  }
  std::atomic<int> done = 0;
  const auto task = [&](std::size_t) { ++done; };
  pool.execute(8, TaskRef(task));
  EXPECT_EQ(done, 8) << "and the pool goes on";
}

TEST(ThreadPoolFaults, TwoRunsMayShareAnEngine) {
  Synthesizer straight(settings_of(40, 32)), engine(settings_of(40, 32));
  straight.run(picture, at_samples(3000));
  std::atomic<std::size_t> calls = 0;
  const auto sampler = [&](double x, double y) {
    ++calls;
    return picture(x, y);
  };
  // A run that finds all of a wave in other hands ends with `waiting`; then it asks again.
  const auto until_done = [&] {
    while (engine.run(sampler, at_samples(3000), SerialExecutor{}, KeepGoing{}, 3).reason ==
           StopReason::waiting) {
      std::this_thread::yield();
    }
  };
  std::thread other(until_done);
  until_done();
  other.join();
  EXPECT_EQ(calls, helpers::calls_of(straight));
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

}  // namespace
}  // namespace freqsynth
