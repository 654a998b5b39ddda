// SPDX-License-Identifier: MIT
#include "freqsynth/engine/thread_pool.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"

namespace freqsynth {
namespace {

/// The pool whose task this thread is running.
thread_local const void* current_pool = nullptr;

}  // namespace

struct ThreadPool::State {
  std::mutex caller;  // held by whoever has its tasks run

  std::mutex mutex;
  std::condition_variable wake, done;
  const TaskRef* task = nullptr;
  std::size_t count = 0;
  std::size_t next = 0;      // first task that nobody has taken
  std::size_t finished = 0;  // tasks that have returned
  std::exception_ptr error;  // of the first task that threw
  bool stop = false;
  std::vector<std::thread> threads;

  explicit State(std::size_t threads_wanted);
  ~State();

  /// Runs tasks until none is left. Takes and returns the lock.
  void work(std::unique_lock<std::mutex>& lock);
  void serve();
  /// Ends the threads that there are.
  void join();
};

ThreadPool::State::State(std::size_t threads_wanted) {
  threads.reserve(threads_wanted);
  try {
    while (threads.size() + 1 < threads_wanted) threads.emplace_back([this] { serve(); });
  } catch (...) {
    join();
    throw;
  }
}

ThreadPool::State::~State() { join(); }

void ThreadPool::State::join() {
  {
    const std::lock_guard lock(mutex);
    stop = true;
  }
  wake.notify_all();
  for (std::thread& thread : threads) thread.join();
  threads.clear();
}

void ThreadPool::State::serve() {
  std::unique_lock lock(mutex);
  while (!stop) {
    work(lock);
    wake.wait(lock, [&] { return stop || next < count; });
  }
}

void ThreadPool::State::work(std::unique_lock<std::mutex>& lock) {
  const void* outer = std::exchange(current_pool, this);
  while (next < count) {
    const std::size_t index = next++;
    const TaskRef run = *task;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      run(index);
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    if (thrown && !error) error = thrown;
    if (++finished == count) done.notify_all();
  }
  current_pool = outer;
}

ThreadPool::ThreadPool(std::size_t threads) {
  if (threads > 1024) {
    detail::refuse("threads is " + std::to_string(threads) + ", not in 0..1024");
  }
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  state_ = new State(threads);
}

ThreadPool::~ThreadPool() { delete state_; }

void ThreadPool::execute(std::size_t count, TaskRef task) {
  if (count == 0) return;
  if (current_pool == state_) return SerialExecutor::execute(count, task);
  const std::lock_guard turn(state_->caller);
  std::unique_lock lock(state_->mutex);
  state_->task = &task;
  state_->next = state_->finished = 0;
  state_->count = count;
  state_->wake.notify_all();
  state_->work(lock);
  state_->done.wait(lock, [&] { return state_->finished == state_->count; });
  state_->count = state_->next = state_->finished = 0;
  if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
}

std::size_t ThreadPool::concurrency() const { return state_->threads.size() + 1; }

}  // namespace freqsynth
