// SPDX-License-Identifier: MIT
/// \file
/// How arguments are refused: an std::invalid_argument that names the value and what it must be.
#pragma once

#include <string>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// \throws std::invalid_argument "freqsynth: <what>", always.
[[noreturn]] FREQSYNTH_API void refuse(const std::string& what);

/// \throws std::invalid_argument "freqsynth: <name> is <value>, not <range>", always.
[[noreturn]] FREQSYNTH_API void refuse_value(const char* name, double value, const char* range);

/// refuse_value() unless `good`.
inline void require(bool good, const char* name, double value, const char* range) {
  if (!good) [[unlikely]] {
    refuse_value(name, value, range);
  }
}

/// A number as people write it, to 9 digits: 0.1, 4096, 1e-300, nan.
[[nodiscard]] FREQSYNTH_API std::string to_text(double value);

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/check.inl"
#endif
