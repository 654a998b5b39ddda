#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "freqsynth/engine/executor.h"

namespace freqsynth {

struct ThreadPool::State {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable wake, done;
  const TaskRef* task = nullptr;
  std::size_t count = 0;
  std::size_t next = 0;      // first task that nobody has taken
  std::size_t finished = 0;  // tasks that have returned
  bool stop = false;

  /// Runs tasks until none is left. Takes and returns the lock.
  void work(std::unique_lock<std::mutex>& lock) {
    while (next < count) {
      const std::size_t index = next++;
      const TaskRef run = *task;
      lock.unlock();
      run(index);
      lock.lock();
      if (++finished == count) done.notify_all();
    }
  }
};

ThreadPool::ThreadPool(std::size_t threads) : state_(std::make_unique<State>()) {
  if (threads > 1024) {
    throw std::invalid_argument("freqsynth: threads is " + std::to_string(threads) +
                                ", not in 0..1024");
  }
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  for (std::size_t i = 1; i < threads; ++i) {
    state_->threads.emplace_back([state = state_.get()] {
      std::unique_lock lock(state->mutex);
      while (!state->stop) {
        state->work(lock);
        state->wake.wait(lock, [&] { return state->stop || state->next < state->count; });
      }
    });
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->stop = true;
  }
  state_->wake.notify_all();
  for (std::thread& thread : state_->threads) thread.join();
}

void ThreadPool::execute(std::size_t count, TaskRef task) {
  if (count == 0) return;
  std::unique_lock lock(state_->mutex);
  state_->task = &task;
  state_->next = state_->finished = 0;
  state_->count = count;
  state_->wake.notify_all();
  state_->work(lock);
  state_->done.wait(lock, [&] { return state_->finished == state_->count; });
}

std::size_t ThreadPool::concurrency() const { return state_->threads.size() + 1; }

}  // namespace freqsynth
