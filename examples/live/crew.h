// SPDX-License-Identifier: MIT
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace live {

/// A queue of connections that has an end: when all threads are busy, no further connection is
/// accepted until one is free.
class Crew : public httplib::TaskQueue {
 public:
  explicit Crew(std::size_t threads) : free_(threads), pool_(threads) {}

  void enqueue(std::function<void()> task) override {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return free_ > 0; });
      --free_;
    }
    pool_.enqueue([this, task = std::move(task)] {
      task();
      const std::lock_guard lock(mutex_);
      ++free_;
      changed_.notify_one();
    });
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t free_;
  httplib::ThreadPool pool_;
};

}  // namespace live
