// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "common/cpu_seconds.h"

namespace live {

/// Keeps what one thread does to a share of the CPU time that all others take.
class Pace {
 public:
  explicit Pace(double share) : share_(share) {}

  /// Whether work of so many CPU seconds stays within the share.
  [[nodiscard]] bool affords(double seconds) const {
    const double others = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - begin_ - spent_;
    return spent_ + seconds <= share_ * others;
  }

  /// Does work of this thread. \return the CPU seconds that it took
  template <class Work>
  double spend(Work&& work) {
    const double before = cpu_seconds(CLOCK_THREAD_CPUTIME_ID);
    std::forward<Work>(work)();
    const double seconds = cpu_seconds(CLOCK_THREAD_CPUTIME_ID) - before;
    spent_ += seconds;
    return seconds;
  }

 private:
  double share_;
  double begin_ = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
  double spent_ = 0;
};

}  // namespace live
