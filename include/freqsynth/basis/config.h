// SPDX-License-Identifier: MIT
/// \file
/// Version, block constants, and the macros of the two ways to build: what every other header may
/// rely on.
///
/// The library is used compiled (the default, target freqsynth::freqsynth), or header-only: define
/// FREQSYNTH_HEADER_ONLY in every file that includes it (target freqsynth::header_only does), and
/// there is nothing to build or link. A header x.h holds declarations, x.inl the definitions; with
/// FREQSYNTH_HEADER_ONLY x.h includes x.inl, otherwise src/ does, once. One program uses one way.
#pragma once

#include <cassert>
#include <cstddef>

/// \{
/// The version's three numbers, and the version as text.
#define FREQSYNTH_VERSION_MAJOR 0
#define FREQSYNTH_VERSION_MINOR 1
#define FREQSYNTH_VERSION_PATCH 0
#define FREQSYNTH_VERSION "0.1.0"
/// \}

/// Checks an invariant of the library itself. Callers' mistakes throw instead.
#ifndef FREQSYNTH_ASSERT
#define FREQSYNTH_ASSERT(condition) assert(condition)
#endif

/// \def FREQSYNTH_INLINE
/// Stands before definitions in x.inl.
/// \def FREQSYNTH_API
/// Stands before what a shared library shows to the world: with FREQSYNTH_SHARED, which the target
/// of a shared library sets for its users. A static library hides all of it, so that a plug-in made
/// with it shows nothing of it.
#if defined(FREQSYNTH_HEADER_ONLY)
#define FREQSYNTH_INLINE inline
#else
#define FREQSYNTH_INLINE
#endif
#if defined(FREQSYNTH_HEADER_ONLY) || !defined(FREQSYNTH_SHARED)
#define FREQSYNTH_API
#elif !defined(_WIN32)
#define FREQSYNTH_API __attribute__((visibility("default")))
#elif defined(FREQSYNTH_BUILDING)
#define FREQSYNTH_API __declspec(dllexport)
#else
#define FREQSYNTH_API __declspec(dllimport)
#endif

namespace freqsynth {

/// Edge length of a block in pixels; the block is the unit of fitting, priority and JPEG.
inline constexpr std::size_t block_size = 8;

/// Number of cosine terms of a complete block, block_size squared.
inline constexpr std::size_t max_terms = block_size * block_size;

}  // namespace freqsynth
