// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/jpeg/quantization_tables.h"

namespace freqsynth {
namespace detail {

constexpr QuantizationTable to_zigzag(const std::array<std::uint16_t, max_terms>& rows) {
  QuantizationTable table{};
  for (std::size_t i = 0; i < max_terms; ++i) table[i] = rows[zigzag_to_row_major[i]];
  return table;
}

// clang-format off
inline constexpr QuantizationTable figure_5 = to_zigzag({
    16, 11, 10, 16,  24,  40,  51,  61,
    12, 12, 14, 19,  26,  58,  60,  55,
    14, 13, 16, 24,  40,  57,  69,  56,
    14, 17, 22, 29,  51,  87,  80,  62,
    18, 22, 37, 56,  68, 109, 103,  77,
    24, 35, 55, 64,  81, 104, 113,  92,
    49, 64, 78, 87, 103, 121, 120, 101,
    72, 92, 95, 98, 112, 100, 103,  99});

inline constexpr QuantizationTable table_k2 = to_zigzag({
    17, 18, 24, 47, 99, 99, 99, 99,
    18, 21, 26, 66, 99, 99, 99, 99,
    24, 26, 56, 99, 99, 99, 99, 99,
    47, 66, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99});
// clang-format on

FREQSYNTH_INLINE void check_table(const QuantizationTable& table, const char* name) {
  if (std::find(table.begin(), table.end(), 0) != table.end()) {
    refuse(std::string(name) + " holds a 0");
  }
}

}  // namespace detail

FREQSYNTH_INLINE const QuantizationTable& luminance_table() { return detail::figure_5; }
FREQSYNTH_INLINE const QuantizationTable& chrominance_table() { return detail::table_k2; }

FREQSYNTH_INLINE QuantizationTable scale_table(const QuantizationTable& table, int quality) {
  detail::require(quality >= 1 && quality <= 100, "quality", quality, "in 1..100");
  detail::check_table(table, "the given quantization table");
  const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  QuantizationTable scaled{};
  for (std::size_t i = 0; i < max_terms; ++i) {
    scaled[i] = static_cast<std::uint16_t>(std::clamp((table[i] * scale + 50) / 100, 1, 255));
  }
  return scaled;
}

}  // namespace freqsynth
