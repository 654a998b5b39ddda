// SPDX-License-Identifier: MIT
#include "freqsynth/engine/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
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

/// How long a thread looks out for what comes next before it sleeps: about as long as it takes to
/// wake one. Between two calls of a run there is often less to do.
constexpr std::chrono::microseconds patience{30};

/// Until `come` holds, but not for long.
template <class Predicate>
void look_out(const Predicate& come) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!come() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

}  // namespace

struct ThreadPool::State {
  std::mutex caller;  // held by whoever has its tasks run

  std::mutex mutex;
  std::condition_variable wake, done;
  const TaskRef* task = nullptr;
  std::size_t count = 0;
  std::size_t next = 0;      // first task that nobody has taken
  std::exception_ptr error;  // of the first task that threw
  bool stop = false;
  // Written under the lock, and read without by who looks out for a change.
  std::atomic<std::size_t> finished{0};  // tasks that have returned
  std::atomic<std::size_t> calls{0};     // that there were, and the end
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
    ++calls;
  }
  wake.notify_all();
  for (std::thread& thread : threads) thread.join();
  threads.clear();
}

void ThreadPool::State::serve() {
  std::unique_lock lock(mutex);
  while (!stop) {
    work(lock);
    const std::size_t known = calls;
    lock.unlock();
    look_out([&] { return calls != known; });
    lock.lock();
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
  state_->next = 0;
  state_->finished = 0;
  state_->count = count;
  ++state_->calls;
  state_->wake.notify_all();
  state_->work(lock);
  const auto all_done = [&] { return state_->finished == count; };
  if (!all_done()) {
    lock.unlock();
    look_out(all_done);
    lock.lock();
    state_->done.wait(lock, all_done);
  }
  state_->count = state_->next = 0;
  if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
}

std::size_t ThreadPool::concurrency() const { return state_->threads.size() + 1; }

}  // namespace freqsynth
