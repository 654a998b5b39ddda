// SPDX-License-Identifier: MIT
/// \file
/// How `run` uses several threads: an executor runs independent tasks. The library itself starts no
/// thread unless the host constructs a ThreadPool (thread_pool.h); a host with a pool of its own
/// wraps that one.
#pragma once

#include <concepts>
#include <cstddef>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// A reference to a callable `void(std::size_t)`; must not outlive it. Cheaper than a
/// std::function.
class TaskRef {
 public:
  /// Refers to `function`, which must live as long.
  template <class F>
  requires std::invocable<const F&, std::size_t>
  explicit TaskRef(const F& function) : object_(&function), call_(&call<F>) {}

  /// Calls it.
  void operator()(std::size_t index) const { call_(object_, index); }

 private:
  template <class F>
  static void call(const void* object, std::size_t index) {
    (*static_cast<const F*>(object))(index);
  }

  const void* object_;
  void (*call_)(const void*, std::size_t);
};

/// Runs task(0) .. task(count - 1), once each, in any order and on any threads, and returns when
/// all are done. The tasks of Synthesizer::run() never throw. `concurrency()` is how many run at
/// the same time at best. An executor that throws must not have a task still running then.
template <class E>
concept Executor = requires(E& executor, std::size_t count, TaskRef task) {
  executor.execute(count, task);
  { executor.concurrency() } -> std::convertible_to<std::size_t>;
};

/// Runs everything on the calling thread.
struct SerialExecutor {
  /// See Executor.
  static void execute(std::size_t count, TaskRef task) {
    for (std::size_t i = 0; i < count; ++i) task(i);
  }
  /// See Executor.
  static constexpr std::size_t concurrency() { return 1; }
};

namespace detail {

/// A reference to an executor; by itself, to one that runs everything on the calling thread.
class ExecutorRef {
 public:
  ExecutorRef()
      : executor_(nullptr),
        execute_(
            [](void*, std::size_t count, TaskRef task) { SerialExecutor::execute(count, task); }),
        concurrency_([](void*) { return SerialExecutor::concurrency(); }) {}
  template <Executor E>
  explicit ExecutorRef(E& executor)
      : executor_(const_cast<void*>(static_cast<const void*>(&executor))),
        execute_([](void* object, std::size_t count, TaskRef task) {
          static_cast<E*>(object)->execute(count, task);
        }),
        concurrency_(
            [](void* object) -> std::size_t { return static_cast<E*>(object)->concurrency(); }) {}

  void execute(std::size_t count, TaskRef task) const { execute_(executor_, count, task); }
  [[nodiscard]] std::size_t concurrency() const { return concurrency_(executor_); }
  /// Whether it stands for the calling thread, with no executor of a host's.
  [[nodiscard]] bool is_serial() const { return executor_ == nullptr; }

 private:
  void* executor_;
  void (*execute_)(void*, std::size_t, TaskRef);
  std::size_t (*concurrency_)(void*);
};

}  // namespace detail

}  // namespace freqsynth
