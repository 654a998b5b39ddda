// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "freqsynth/basis/large_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace freqsynth::detail {

FREQSYNTH_INLINE void ask_for_large_pages([[maybe_unused]] void* memory,
                                          [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t skipped = (large_page - begin % large_page) % large_page;
  if (skipped + large_page > bytes) return;
  // A hint: that a kernel does not take it is no error.
  madvise(static_cast<char*>(memory) + skipped, (bytes - skipped) / large_page * large_page,
          MADV_HUGEPAGE);
#endif
}

}  // namespace freqsynth::detail
