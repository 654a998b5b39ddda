// SPDX-License-Identifier: MIT
/// \file
/// CPU time, which does not grow while others compute.
#pragma once

#include <ctime>

/// Seconds of CPU time by a clock of the system's.
/// \param clock  CLOCK_THREAD_CPUTIME_ID: of this thread; CLOCK_PROCESS_CPUTIME_ID: of all
inline double cpu_seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
