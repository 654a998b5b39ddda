// SPDX-License-Identifier: MIT
/// \file
/// A pool of threads, for hosts that have none. Part of the compiled library only.
#pragma once

#if defined(FREQSYNTH_HEADER_ONLY)
#error \
    "freqsynth/engine/thread_pool.h: ThreadPool needs the compiled library, freqsynth::freqsynth; \
header-only, wrap a pool of your own as an Executor"
#endif

#include <cstddef>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"

namespace freqsynth {

/// A pool of threads that lives as long as the object. The calling thread works along.
class FREQSYNTH_API ThreadPool {
 public:
  /// \param threads how many work together, the caller included; 0: one per hardware thread
  /// \throws std::invalid_argument when threads > 1024, std::system_error when the system cannot
  ///         start as many (no thread is left behind then), std::bad_alloc.
  explicit ThreadPool(std::size_t threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// See Executor. May be called from several threads, one of which is served after the other; a
  /// call from within a task runs its own tasks on the calling thread.
  ///
  /// When tasks throw, the others still run, and then the first exception goes on to the caller.
  void execute(std::size_t count, TaskRef task);
  /// Threads that work together, the caller's included.
  [[nodiscard]] std::size_t concurrency() const;

 private:
  struct State;
  State* state_;
};

}  // namespace freqsynth
