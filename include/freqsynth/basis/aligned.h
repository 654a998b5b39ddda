// SPDX-License-Identifier: MIT
/// \file
/// Memory that starts on a cache line, as the vectorised kernels want it: of fixed size, and not.
#pragma once

#include <array>
#include <cstddef>
#include <new>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// Bytes of a cache line, and more than any vector register needs.
inline constexpr std::size_t alignment = 64;

/// An std::array that starts on a cache line.
template <class T, std::size_t N>
struct alignas(alignment) AlignedArray : std::array<T, N> {};

/// One number per term or per pixel of a block.
using AlignedBlock = AlignedArray<float, max_terms>;

/// Allocates from cache line to cache line.
template <class T>
struct AlignedAllocator {
  using value_type = T;

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}  // NOLINT: containers convert it

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{alignment}));
  }
  void deallocate(T* memory, std::size_t) noexcept {
    ::operator delete (memory, std::align_val_t{alignment});
  }

  template <class U>
  bool operator==(const AlignedAllocator<U>&) const {
    return true;
  }
};

/// An std::vector whose memory starts on a cache line.
template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace freqsynth::detail
