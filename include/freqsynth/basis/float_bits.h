// SPDX-License-Identifier: MIT
/// \file
/// What kind of number a floating-point value is, told from its bits: right also where the compiler
/// was told that there are finite numbers only (-ffast-math, usual in renderers).
#pragma once

#include <bit>
#include <cstdint>

namespace freqsynth::detail {

[[nodiscard]] constexpr bool is_finite(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) != 0x7f800000u;
}

[[nodiscard]] constexpr bool is_finite(double value) {
  return (std::bit_cast<std::uint64_t>(value) & 0x7ff0000000000000u) != 0x7ff0000000000000u;
}

[[nodiscard]] constexpr bool is_nan(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7fffffffu) > 0x7f800000u;
}

[[nodiscard]] constexpr bool is_nan(double value) {
  return (std::bit_cast<std::uint64_t>(value) & 0x7fffffffffffffffu) > 0x7ff0000000000000u;
}

}  // namespace freqsynth::detail
