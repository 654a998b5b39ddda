// SPDX-License-Identifier: MIT
/// \file
/// Large arrays in large pages, where the system has them: their memory is there much sooner, and
/// places all over it are found sooner.
#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// Bytes of a large page.
inline constexpr std::size_t large_page = std::size_t{1} << 21;

/// Asks for large pages for those of this memory that lie within it whole, before it is used for
/// the first time. Linux only; elsewhere, and where the system has none to give, nothing happens.
FREQSYNTH_API void ask_for_large_pages(void* memory, std::size_t bytes);

/// Allocates from cache line to cache line or, where there are large pages, from one to the next
/// what takes at least one of them.
template <class T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}  // NOLINT: containers convert it

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = whole_pages(count * sizeof(T));
    void* const memory = ::operator new(bytes, start(bytes));
    if (bytes >= large_page) ask_for_large_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    ::operator delete(memory, start(count * sizeof(T)));
  }

  template <class U>
  bool operator==(const LargeAllocator<U>&) const {
    return true;
  }

 private:
  /// A last page that is to be used by half or more is taken whole: as many small ones cost more.
  static std::size_t whole_pages(std::size_t bytes) {
#if defined(__linux__)
    const std::size_t rest = bytes % large_page;
    if (bytes >= large_page && rest >= large_page / 2) bytes += large_page - rest;
#endif
    return bytes;
  }
  static std::align_val_t start([[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    if (bytes >= large_page) return std::align_val_t{large_page};
#endif
    return std::align_val_t{alignment};
  }
};

/// The same, and new numbers are not set: a container is told what they are, or has them written at
/// once.
template <class T>
struct UnsetAllocator : LargeAllocator<T> {
  UnsetAllocator() = default;
  template <class U>
  UnsetAllocator(const UnsetAllocator<U>&) {}  // NOLINT: containers convert it

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// An std::vector in large pages.
template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;
/// The same, whose resize() leaves new numbers as they are, see UnsetAllocator.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/large_pages.inl"
#endif
