// SPDX-License-Identifier: MIT
/// \file
/// Work in stages, each of which is in pieces that any threads take: one is enough, and whoever
/// comes along can help.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// A piece of work is at work on one thread and waits for nothing. So no thread waits in here for
/// longer than others take for a piece each and the step between two stages. All members may be
/// called from any thread; nothing allocates.
class TeamWork {
 public:
  /// What is to be done. None of the functions throws.
  struct Job {
    void* object = nullptr;                                     ///< handed on to the functions
    void (*piece)(void* object, std::size_t number) = nullptr;  ///< does a piece of the stage
    std::size_t (*next_stage)(void* object) = nullptr;  ///< prepares the next stage, when all of a
                                                        ///< stage is done; returns its pieces, 0
                                                        ///< when there is none
  };

  /// Starts a job whose first stage has so many pieces, at least one. None is under way.
  void begin(const Job& job, std::size_t pieces);
  /// Whether a job is under way.
  [[nodiscard]] bool active() const { return active_.load(std::memory_order_acquire); }
  /// Pieces of the stage that nobody has taken yet.
  [[nodiscard]] std::size_t left() const;

  /// Does one piece, if one is left in this stage.
  void help();
  /// Helps until the stage and the step after it are done. \return whether there is another one
  bool finish_stage();
  /// Helps until the job is done, if one is under way.
  void finish() {
    while (finish_stage()) {
    }
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  bool take(Lock& lock);
  void pass_on(Lock& lock);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Job job_;
  std::atomic<bool> active_{false};
  std::uint64_t stage_ = 0;   // of all jobs
  std::size_t count_ = 0;     // pieces of the stage
  std::size_t taken_ = 0;     // of these
  std::size_t finished_ = 0;  // of these
  bool passing_on_ = false;   // somebody prepares the next stage
};

// ------------------------------------------------------------------------------------ definitions

inline void TeamWork::begin(const Job& job, std::size_t pieces) {
  const Lock lock(mutex_);
  FREQSYNTH_ASSERT(!active() && pieces > 0);
  job_ = job;
  count_ = pieces;
  taken_ = finished_ = 0;
  active_.store(true, std::memory_order_release);
}

inline std::size_t TeamWork::left() const {
  const Lock lock(mutex_);
  return active() ? count_ - taken_ : 0;
}

inline void TeamWork::help() {
  Lock lock(mutex_);
  take(lock);
}

inline bool TeamWork::finish_stage() {
  Lock lock(mutex_);
  const std::uint64_t stage = stage_;
  while (active() && stage_ == stage) {
    if (take(lock)) continue;
    if (finished_ == count_ && !passing_on_) {
      pass_on(lock);
    } else {
      changed_.wait(lock);
    }
  }
  return active();
}

/// Does one piece. \return whether one was left
inline bool TeamWork::take(Lock& lock) {
  if (!active() || taken_ == count_) return false;
  const std::size_t number = taken_++;
  const Job job = job_;
  lock.unlock();
  job.piece(job.object, number);
  lock.lock();
  if (++finished_ == count_) changed_.notify_all();
  return true;
}

/// To the next stage.
inline void TeamWork::pass_on(Lock& lock) {
  passing_on_ = true;
  const Job job = job_;
  lock.unlock();
  const std::size_t pieces = job.next_stage(job.object);
  lock.lock();
  passing_on_ = false;
  ++stage_;
  count_ = pieces;
  taken_ = finished_ = 0;
  if (pieces == 0) active_.store(false, std::memory_order_release);
  changed_.notify_all();
}

}  // namespace freqsynth::detail
