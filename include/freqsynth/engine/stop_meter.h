// SPDX-License-Identifier: MIT
/// \file
/// How far along the stop rules are, and whether the time is over.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/stop_rule.h"

namespace freqsynth {

/// A stopwatch that is started when rules are set.
class StopMeter {
 public:
  /// It never runs backwards.
  using Clock = std::chrono::steady_clock;

  /// What is done, as shares of what is allowed: 1 is the end, 0 also stands for no limit.
  struct Shares {
    double samples = 0;  ///< of the samples of the image
    double blocks = 0;   ///< of the samples that blocks may have
    double error = 0;    ///< of the samples that a target of the error takes, roughly
  };

  /// Starts. \param seconds  see StopRule::seconds
  void begin(double seconds, const Shares& now) {
    begun_ = Clock::now();
    first_ = now;
    // Of more than that no clock could hold the end.
    constexpr double most = 1e9;
    limited_ = detail::is_finite(seconds) && seconds <= most;
    seconds_ = limited_ ? seconds : 0;
  }

  /// When the time is over; none: never.
  [[nodiscard]] std::optional<Clock::time_point> deadline() const {
    if (!limited_) return std::nullopt;
    return begun_ + std::chrono::ceil<Clock::duration>(std::chrono::duration<double>(seconds_));
  }
  /// Whether it is.
  [[nodiscard]] bool out_of_time() const { return limited_ && Clock::now() >= *deadline(); }

  /// All that shares and time say. \param ended  whether another rule has ended it
  [[nodiscard]] Progress progress(const Shares& now, bool ended) const;

 private:
  static double seconds_left(double passed, double first, double now) {
    return now > first ? passed * (1 - now) / (now - first)
                       : std::numeric_limits<double>::infinity();
  }

  Clock::time_point begun_ = Clock::now();
  Shares first_;
  bool limited_ = false;
  double seconds_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

inline Progress StopMeter::progress(const Shares& now, bool ended) const {
  const Clock::time_point time = Clock::now();
  Progress progress;
  progress.seconds = std::chrono::duration<double>(time - begun_).count();
  if (ended || (limited_ && time >= *deadline())) {
    progress.fraction = 1;
    progress.seconds_left = 0;
    return progress;
  }
  const double shares = std::max({now.samples, now.blocks, now.error});
  const double of_time = limited_ ? progress.seconds / seconds_ : 0;
  constexpr double below_one = 1 - std::numeric_limits<double>::epsilon() / 2;
  progress.fraction = std::min(std::max(shares, of_time), below_one);
  progress.seconds_left = std::min({seconds_left(progress.seconds, first_.samples, now.samples),
                                    seconds_left(progress.seconds, first_.blocks, now.blocks),
                                    seconds_left(progress.seconds, first_.error, now.error)});
  if (limited_) {
    progress.seconds_left = std::min(progress.seconds_left, seconds_ - progress.seconds);
  }
  progress.seconds_left = std::max(progress.seconds_left, 0.0);
  return progress;
}

}  // namespace freqsynth
