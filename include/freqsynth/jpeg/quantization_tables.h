// SPDX-License-Identifier: MIT
/// \file
/// The quantiser's tables (paper, section 2, figure 5): those of the JPEG standard, and finer and
/// coarser ones.
#pragma once

#include <array>
#include <cstdint>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Quantiser steps Q(u, v) >= 1 in zig-zag order.
using QuantizationTable = std::array<std::uint16_t, max_terms>;

/// The table of figure 5, the example for luminance in the JPEG standard (ITU-T T.81, table K.1).
[[nodiscard]] FREQSYNTH_API const QuantizationTable& luminance_table();

/// The standard's example for chrominance (table K.2).
[[nodiscard]] FREQSYNTH_API const QuantizationTable& chrominance_table();

/// `table` made finer or coarser like libjpeg does: 50 leaves it as it is, 100 makes all steps 1.
/// Steps stay in 1..255, the range of baseline JPEG.
/// \throws std::invalid_argument when quality is not in 1..100 or the table holds a zero.
[[nodiscard]] FREQSYNTH_API QuantizationTable scale_table(const QuantizationTable& table,
                                                          int quality);

namespace detail {

/// \throws std::invalid_argument "freqsynth: <name> holds a 0" when it does.
void check_table(const QuantizationTable& table, const char* name);

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/quantization_tables.inl"
#endif
