// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>

namespace freqsynth::test {

/// The most memory that this process ever held, in bytes.
inline long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;
}

}  // namespace freqsynth::test
