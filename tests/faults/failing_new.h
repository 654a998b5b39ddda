// SPDX-License-Identifier: MIT
/// \file
/// Memory that runs out on demand. A program that links failing_new.cpp allocates through it.
#pragma once

#include <cstddef>

namespace faults {

/// Allocations of this thread since the program's start, and the bytes of those that still live,
/// of all threads.
std::size_t allocations();
std::size_t bytes_in_use();

/// From construction on, the allocation of this thread with that number (0: the next one) fails
/// with std::bad_alloc, once.
class FailAllocation {
 public:
  explicit FailAllocation(std::size_t number);
  ~FailAllocation();
  FailAllocation(const FailAllocation&) = delete;
  FailAllocation& operator=(const FailAllocation&) = delete;

  /// Whether it has come to that.
  [[nodiscard]] bool failed() const;
};

}  // namespace faults
