// SPDX-License-Identifier: MIT
/// \file
/// Work in pieces, shared by the threads of an executor.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"

// Ending a thread from outside unwinds its stack by an exception that may not be swallowed.
#if defined(__GLIBCXX__) && defined(__linux__)
#include <cxxabi.h>
#define FREQSYNTH_RETHROW_CANCELLATION \
  catch (abi::__forced_unwind&) {      \
    throw;                             \
  }
#else
#define FREQSYNTH_RETHROW_CANCELLATION
#endif

namespace freqsynth::detail {

/// The numbers 0 .. count - 1, each of which is taken once.
class WorkPieces {
 public:
  explicit WorkPieces(std::size_t count) : count_(count) {}

  /// Takes one. \return whether there was any
  bool take(std::size_t& piece) {
    piece = next_.fetch_add(1, std::memory_order_relaxed);
    return piece < count_;
  }

 private:
  friend class WorkErrors;
  std::size_t count_;
  std::atomic<std::size_t> next_{0};
};

/// Runs workers, and keeps the first exception of one.
class WorkErrors {
 public:
  template <class Worker>
  void run(WorkPieces& pieces, const Worker& worker) {
    try {
      worker(pieces);
    }
    FREQSYNTH_RETHROW_CANCELLATION
    catch (...) {
      if (!any_.exchange(true)) error_ = std::current_exception();
      // The others need not go on.
      pieces.next_.store(pieces.count_, std::memory_order_relaxed);
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<bool> any_{false};
  std::exception_ptr error_;
};

/// Calls worker(pieces) on up to as many threads as the executor has; each takes pieces until there
/// are none. All are done at the return, by the calling thread where the executor leaves out tasks.
/// \throws what a worker or the executor throws.
template <class Worker>
void share_work(const ExecutorRef& executor, std::size_t count, const Worker& worker) {
  WorkPieces pieces(count);
  WorkErrors errors;
  const auto task = [&](std::size_t) { errors.run(pieces, worker); };
  const std::size_t tasks = std::min(executor.concurrency(), count);
  if (tasks > 1) executor.execute(tasks, TaskRef(task));
  if (count > 0) task(0);
  errors.rethrow();
}

/// The same for pieces that need nothing but their number.
template <class Work>
void share_pieces(const ExecutorRef& executor, std::size_t count, const Work& work) {
  share_work(executor, count, [&](WorkPieces& pieces) {
    for (std::size_t piece; pieces.take(piece);) work(piece);
  });
}

}  // namespace freqsynth::detail
