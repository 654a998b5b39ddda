// SPDX-License-Identifier: MIT
/// \file
/// Whether a sampler returns Monte Carlo estimates.
#pragma once

#include <cstdint>

namespace freqsynth {

/// Noise is what makes a sampler return another value when it is asked for the same position again.
/// It is smoothed more than detail is, and only more samples make it smaller.
enum class Noise : std::uint8_t {
  automatic,  ///< present once it has been seen
  none,       ///< every value is taken for what is there
  present     ///< every value is taken for an estimate
};

}  // namespace freqsynth
