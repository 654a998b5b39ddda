// SPDX-License-Identifier: MIT
/// \file
/// Bits that look random, from bits that do not.
#pragma once

#include <cstdint>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// Distance of the seeds of independent streams: 2^64 over the golden ratio, odd.
inline constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15u;

/// A bijection of the 64-bit numbers that leaves no pattern of its argument visible: the finaliser
/// of SplitMix64 (Steele, Lea and Flood 2014). 0 stays 0.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

}  // namespace freqsynth::detail
