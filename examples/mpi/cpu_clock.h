// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>

namespace farm {

/// Seconds of CPU time that this thread has taken.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Adds the CPU time of its scope to a sum.
class CpuClock {
 public:
  explicit CpuClock(double& sum) : sum_(sum) {}
  CpuClock(const CpuClock&) = delete;
  CpuClock& operator=(const CpuClock&) = delete;
  ~CpuClock() { sum_ += cpu_seconds() - begin_; }

 private:
  double& sum_;
  double begin_ = cpu_seconds();
};

}  // namespace farm
