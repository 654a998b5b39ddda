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
///
/// New numbers are not set: a container is told what they are, or has them written at once.
template <class T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}  // NOLINT: containers convert it

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, start(bytes));
    if (bytes >= large_page) ask_for_large_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    ::operator delete(memory, start(count * sizeof(T)));
  }

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  template <class U>
  bool operator==(const LargeAllocator<U>&) const {
    return true;
  }

 private:
  static std::align_val_t start([[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    if (bytes >= large_page) return std::align_val_t{large_page};
#endif
    return std::align_val_t{alignment};
  }
};

/// An std::vector in large pages. resize() leaves new numbers as they are, see LargeAllocator.
template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/large_pages.inl"
#endif
