// SPDX-License-Identifier: MIT
/// \file
/// Where the newest revision hangs.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "revision.h"

namespace live {

/// Keeps the newest revision only: who is slow gets that one, and those before are dropped as soon
/// as nobody reads them. Members may be called from any thread.
class Board {
 public:
  using Shared = std::shared_ptr<const Revision>;

  /// Hangs up a revision, and numbers it.
  void publish(Revision revision) {
    const std::lock_guard lock(mutex_);
    revision.number = newest_ ? newest_->number + 1 : 1;
    newest_ = std::make_shared<const Revision>(std::move(revision));
    changed_.notify_all();
  }

  /// The newest one; none before the first.
  [[nodiscard]] Shared newest() const {
    const std::lock_guard lock(mutex_);
    return newest_;
  }

  /// Waits for one with a number above `number`, for so long or until close().
  [[nodiscard]] Shared newer_than(std::uint64_t number, std::chrono::milliseconds most) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [&] { return closed_ || (newest_ && newest_->number > number); });
    return newest_;
  }

  /// From now on nobody waits.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Shared newest_;
  bool closed_ = false;
};

}  // namespace live
