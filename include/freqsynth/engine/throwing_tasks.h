// SPDX-License-Identifier: MIT
/// \file
/// Tasks that may throw, on executors whose tasks must not.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"

namespace freqsynth::detail {

/// Runs task(0) .. task(count - 1) on an executor. When one throws, those that have not begun are
/// left out, and one of the exceptions is thrown in the end.
template <class Task>
void execute_all(const ExecutorRef& executor, std::size_t count, const Task& task) {
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  const auto guarded = [&](std::size_t index) {
    if (failed.load(std::memory_order_relaxed)) return;
    try {
      task(index);
    } catch (...) {
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  executor.execute(count, TaskRef(guarded));
  if (failure) std::rethrow_exception(failure);
}

}  // namespace freqsynth::detail
