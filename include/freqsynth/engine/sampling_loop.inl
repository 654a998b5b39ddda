// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/engine/sampling_loop.h"
#include "freqsynth/engine/shared_work.h"

namespace freqsynth::detail {

/// Requests on their way through the sampler, in parts for several threads. Whatever happens, what
/// the sampler answered is delivered and the rest is given back.
/// \tparam E  has request(), deliver() and give_back(), like Engine
template <class E>
class Batch {
 public:
  /// \param concurrency  parts that are at work at the same time, unless the executor lies
  /// \param stride       floats from the values of a request to those of the next
  /// \param packet       parts are multiples of so many requests, the last one aside
  Batch(E& engine, std::size_t stride, std::size_t most, std::size_t most_parts,
        std::size_t concurrency, std::size_t packet)
      : engine_(engine),
        stride_(stride),
        packet_(packet),
        requests_(most),
        values_(most * stride),
        parts_(std::max<std::size_t>(most_parts, 1)),
        expected_at_work_(std::clamp<std::size_t>(concurrency, 1, parts_.size())) {}
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  ~Batch() { settle({}); }

  /// Asks for requests. \return how many parts they make
  std::size_t fill() {
    count_ = engine_.request(requests_);
    packets_ = (count_ + packet_ - 1) / packet_;
    part_count_ = std::min(packets_, parts_.size());
    for (std::size_t i = 0; i < part_count_; ++i) {
      parts_[i].begun.store(false, std::memory_order_relaxed);
      parts_[i].done = 0;
      parts_[i].error = nullptr;
    }
    return part_count_;
  }

  /// Lets the sampler answer a part. A part that was begun before, or is none, is left alone.
  void answer(const SamplerRef& sampler, std::size_t index) {
    if (index >= part_count_ || parts_[index].begun.exchange(true)) return;
    const std::size_t first = first_of(index);
    const std::size_t size = first_of(index + 1) - first;
    const Seat seat(*this);
    if (seat.number() != 0) {
      for (std::size_t i = 0; i < size; ++i) requests_[first + i].thread = seat.number();
    }
    try {
      sampler(std::span<const Request>(requests_).subspan(first, size),
              std::span<float>(values_).subspan(first * stride_, size * stride_),
              parts_[index].done);
    }
    FREQSYNTH_RETHROW_CANCELLATION
    catch (...) {
      parts_[index].error = std::current_exception();
    }
  }

  /// Delivers what was answered and gives back the rest.
  /// \param executor  helps to take in what was delivered
  /// \return the first error of the sampler, or that of the executor
  std::exception_ptr settle(const ExecutorRef& executor) {
    std::exception_ptr error, late;
    for (std::size_t i = 0; i < part_count_; ++i) {
      const std::size_t first = first_of(i);
      const std::size_t size = first_of(i + 1) - first;
      const std::size_t done = parts_[i].done;
      const auto part = std::span<const Request>(requests_).subspan(first, size);
      try {
        engine_.deliver(part.first(done),
                        std::span<const float>(values_).subspan(first * stride_, done * stride_),
                        stride_, executor);
      }
      FREQSYNTH_RETHROW_CANCELLATION
      catch (...) {
        // All was taken. Only the last part can complete a wave.
        late = std::current_exception();
      }
      if (done < size) engine_.give_back(part.subspan(done));
      if (parts_[i].error && !error) error = parts_[i].error;
    }
    part_count_ = 0;
    return error ? error : late;
  }

  /// Parts that the executor has left out.
  [[nodiscard]] std::size_t left_out() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < part_count_; ++i) count += parts_[i].begun ? 0 : 1;
    return count;
  }

 private:
  struct Part {
    std::atomic<bool> begun{false};
    std::atomic<bool> seat_taken{false};  // of the seat with the same number, not this part's
    std::size_t done = 0;                 // requests whose values are there
    std::exception_ptr error;
  };

  /// A number that no other part at work has. As long as no more are at work than the executor has
  /// said, there are so many numbers, and one of them is free.
  class Seat {
   public:
    explicit Seat(Batch& batch) : batch_(batch) {
      const bool expected = batch.at_work_.fetch_add(1) < batch.expected_at_work_;
      const std::size_t first = expected ? 0 : batch.expected_at_work_;
      const std::size_t end = expected ? batch.expected_at_work_ : batch.parts_.size();
      number_ = first;
      while (batch.parts_[number_].seat_taken.exchange(true)) {
        number_ = number_ + 1 < end ? number_ + 1 : first;
      }
    }
    ~Seat() {
      batch_.parts_[number_].seat_taken = false;
      --batch_.at_work_;
    }
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;

    [[nodiscard]] std::uint32_t number() const { return static_cast<std::uint32_t>(number_); }

   private:
    Batch& batch_;
    std::size_t number_;
  };

  [[nodiscard]] std::size_t first_of(std::size_t part) const {
    return std::min(part * packets_ / part_count_ * packet_, count_);
  }

  E& engine_;
  std::size_t stride_, packet_;
  std::vector<Request> requests_;
  AlignedVector<float> values_;
  std::vector<Part> parts_;
  std::size_t expected_at_work_;
  std::atomic<std::size_t> at_work_{0};
  std::size_t count_ = 0, packets_ = 0;
  std::size_t part_count_ = 0;
};

/// See Synthesizer::run().
template <class E>
RunReport run_loop(E& engine, std::size_t channels, const SamplerRef& sampler, const StopRule& stop,
                   const ExecutorRef& executor, const ProgressRef& progress, std::size_t batch) {
  using Clock = std::chrono::steady_clock;
  if (sampler.channels() != channels) {
    refuse("the sampler returns " + std::to_string(sampler.channels()) + " values for " +
           std::to_string(channels) + " channels");
  }
  const std::size_t stride = sampler.stride() == 0 ? channels : sampler.stride();
  require(stride >= channels, "stride", static_cast<double>(stride),
          "at least the number of channels");
  if (batch == 0) refuse("batch is 0");
  engine.set_stop(stop);
  const auto begin = Clock::now();
  Clock::duration sampling{};
  const auto report = [&](StopReason reason) {
    const auto seconds = [](Clock::duration time) {
      return std::chrono::duration<double>(time).count();
    };
    return RunReport{reason, seconds(sampling), seconds(Clock::now() - begin - sampling),
                     engine.stats().differing_probes > 0};
  };
  const std::size_t concurrency = std::max<std::size_t>(executor.concurrency(), 1);
  // As many for each thread: to come together costs time, and time between two reports stays.
  const std::size_t wave = engine.wave_size();
  const std::size_t most = batch > wave / concurrency ? wave : batch * concurrency;
  // A few parts per thread even out the cost of samples.
  const std::size_t most_parts =
      concurrency <= 1 ? 1 : std::min(most, 4 * std::min(concurrency, most));
  Batch<E> requests(engine, stride, most, most_parts, concurrency, engine.packet());
  // An executor is asked once how much it does at a time: it may throw.
  const ExecutorRef helper = concurrency > 1 ? executor : ExecutorRef();
  bool told = false;  // that it has come to its end
  while (const std::size_t parts = requests.fill()) {
    const auto task = [&](std::size_t index) { requests.answer(sampler, index); };
    const auto sampling_begin = Clock::now();
    executor.execute(parts, TaskRef(task));
    sampling += Clock::now() - sampling_begin;
    const std::size_t left_out = requests.left_out();
    if (const std::exception_ptr error = requests.settle(helper)) std::rethrow_exception(error);
    if (left_out > 0) {
      throw std::runtime_error("freqsynth: the executor left out " + std::to_string(left_out) +
                               " of " + std::to_string(parts) + " tasks");
    }
    if (!progress.listens()) continue;
    const Progress now = engine.progress();
    told = now.fraction == 1;
    if (!progress(now)) return report(StopReason::cancelled);
  }
  const StopReason reason = engine.stopped().value_or(StopReason::waiting);
  // An end that no batch has foreseen.
  if (progress.listens() && !told) {
    const Progress now = engine.progress();
    if (now.fraction == 1) progress(now);
  }
  return report(reason);
}

}  // namespace freqsynth::detail
