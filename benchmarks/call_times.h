// SPDX-License-Identifier: MIT
/// \file
/// How long single calls take, on the clock and of their thread's own time, and which of them
/// slept.
///
/// Beside other programs the clock says little: a thread that is put aside by the system loses
/// milliseconds in the middle of a call. Its own time goes on only while it runs, which includes
/// waiting in a loop. And only a thread that waits for another one gives up its processor of its
/// own accord, which the system counts: the clock's time of such a call is what it may have waited.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#if defined(__linux__)
#include <sys/resource.h>
#include <time.h>
#endif

namespace freqsynth::bench {

/// Seconds that this thread has run, and how often it has gone to sleep; 0 but on Linux.
struct ThreadUse {
  double seconds = 0;
  long sleeps = 0;

  static ThreadUse now() {
    ThreadUse use;
#if defined(__linux__)
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    use.seconds = static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    use.sleeps = usage.ru_nvcsw;
#endif
    return use;
  }
};

/// The times of calls of one kind.
class CallTimes {
 public:
  /// Calls it.
  template <class Call>
  auto measure(Call&& call) {
    const ThreadUse before = ThreadUse::now();
    const auto start = std::chrono::steady_clock::now();
    auto result = call();
    const std::chrono::duration<double> clock = std::chrono::steady_clock::now() - start;
    const ThreadUse after = ThreadUse::now();
    clock_.push_back(clock.count());
    own_.push_back(after.seconds - before.seconds);
    if (after.sleeps != before.sleeps) {
      ++slept_;
      longest_sleep_ = std::max(longest_sleep_, clock.count());
    }
    return result;
  }

  /// Those of others, too.
  void add(const CallTimes& others) {
    clock_.insert(clock_.end(), others.clock_.begin(), others.clock_.end());
    own_.insert(own_.end(), others.own_.begin(), others.own_.end());
    slept_ += others.slept_;
    longest_sleep_ = std::max(longest_sleep_, others.longest_sleep_);
  }

  /// The longest call, on the clock.
  [[nodiscard]] double longest() const {
    return clock_.empty() ? 0 : *std::max_element(clock_.begin(), clock_.end());
  }

  /// Writes what there is into a benchmark's counters, in milliseconds: `name`_clock and
  /// `name`_own, each with the median, what 99 of 100 calls do not exceed, and the longest; how
  /// many of the calls slept, and the longest of these on the clock.
  void report(benchmark::State& state, const std::string& name) const {
    report(state, name + "_clock", clock_);
    report(state, name + "_own", own_);
    state.counters[name + "_calls"] = static_cast<double>(clock_.size());
    state.counters[name + "_slept"] = static_cast<double>(slept_);
    state.counters[name + "_slept_longest"] = 1e3 * longest_sleep_;
  }

 private:
  static void report(benchmark::State& state, const std::string& name, std::vector<double> times) {
    if (times.empty()) return;
    std::sort(times.begin(), times.end());
    const auto at = [&](double share) {
      return 1e3 * times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
    };
    state.counters[name + "_p50"] = at(0.5);
    state.counters[name + "_p99"] = at(0.99);
    state.counters[name + "_max"] = at(1);
  }

  std::vector<double> clock_, own_;  // seconds
  std::size_t slept_ = 0;
  double longest_sleep_ = 0;
};

}  // namespace freqsynth::bench
