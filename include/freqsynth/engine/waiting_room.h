// SPDX-License-Identifier: MIT
/// \file
/// Where threads wait for news.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Threads wait until something has changed. News are counted, so that none is missed between a
/// look at the state and the wait: ask for news(), look, then wait for other news. All members may
/// be called from any thread, under other locks too.
class WaitingRoom {
 public:
  /// Number of calls of wake().
  [[nodiscard]] std::uint64_t news() const { return news_; }

  /// Whether anybody waits.
  [[nodiscard]] bool occupied() const { return waiting_ > 0; }

  /// Waits until there are other news than `seen`, or `deadline` has passed.
  void wait(std::uint64_t seen,
            const std::optional<std::chrono::steady_clock::time_point>& deadline) {
    std::unique_lock lock(mutex_);
    const Presence presence(waiting_);
    const auto changed = [&] { return news_ != seen; };
    if (deadline) {
      changed_.wait_until(lock, *deadline, changed);
    } else {
      changed_.wait(lock, changed);
    }
  }

  /// Wakes all that wait.
  void wake() {
    ++news_;
    // Whoever is not counted yet looks at the news after this.
    if (waiting_ == 0) return;
    // Whoever is counted looks at them before the lock can be taken, or waits by then.
    { const std::lock_guard lock(mutex_); }
    changed_.notify_all();
  }

 private:
  struct Presence {
    explicit Presence(std::atomic<int>& count) : waiting(count) { ++waiting; }
    ~Presence() { --waiting; }
    Presence(const Presence&) = delete;
    Presence& operator=(const Presence&) = delete;

    std::atomic<int>& waiting;
  };

  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<std::uint64_t> news_{0};
  std::atomic<int> waiting_{0};
};

}  // namespace freqsynth
