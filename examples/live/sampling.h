// SPDX-License-Identifier: MIT
/// \file
/// An engine at work on a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <thread>

#include "freqsynth/freqsynth.h"
#include "subject.h"

namespace live {

/// Samples from its construction until a number of samples per pixel, or stop().
class Sampling {
 public:
  /// \param threads  that ask the subject; 0: all
  Sampling(freqsynth::Synthesizer& engine, const Subject& subject, double samples_per_pixel,
           std::size_t threads);
  ~Sampling();
  Sampling(const Sampling&) = delete;
  Sampling& operator=(const Sampling&) = delete;

  /// Whether it is over, by itself or by an error.
  [[nodiscard]] bool ended() const { return ended_; }
  /// Seconds from its beginning until now, or its end.
  [[nodiscard]] double seconds() const;
  /// Ends it after what is under way. \throws what the subject has thrown.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  void work(freqsynth::Synthesizer& engine, const Subject& subject, double samples_per_pixel,
            std::size_t threads);

  std::atomic<bool> stopping_ = false;
  std::atomic<bool> ended_ = false;
  std::exception_ptr error_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point end_;
  std::thread thread_;
};

}  // namespace live
