/// \file
/// Version, block constants and the assertion macro: what every other header may rely on.
#pragma once

#include <cassert>
#include <cstddef>

#define FREQSYNTH_VERSION_MAJOR 0
#define FREQSYNTH_VERSION_MINOR 1
#define FREQSYNTH_VERSION_PATCH 0
#define FREQSYNTH_VERSION "0.1.0"

/// Checks an invariant of the library itself. Callers' mistakes throw instead.
#ifndef FREQSYNTH_ASSERT
#define FREQSYNTH_ASSERT(condition) assert(condition)
#endif

namespace freqsynth {

/// Edge length of a block in pixels; the block is the unit of fitting, priority and JPEG.
inline constexpr std::size_t block_size = 8;

/// Number of cosine terms of a complete block, block_size squared.
inline constexpr std::size_t max_terms = block_size * block_size;

}  // namespace freqsynth
