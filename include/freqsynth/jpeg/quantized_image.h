// SPDX-License-Identifier: MIT
/// \file
/// The quantised image as a plain value that any encoder can take (paper, section 2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/jpeg/quantization_tables.h"

namespace freqsynth {

/// One colour component of a quantised image.
struct QuantizedComponent {
  std::size_t blocks_x = 0;  ///< in a row
  std::size_t blocks_y = 0;  ///< in a column
  int horizontal = 1;  ///< sampling factor of JPEG: blocks of this component in a group of blocks
  int vertical = 1;    ///< the same downwards
  std::size_t table = 0;             ///< index of its table
  std::vector<std::int16_t> values;  ///< [block][term], terms in zig-zag order
};

/// An image as quantised coefficients, level-shifted as JPEG stores them.
struct QuantizedImage {
  std::size_t width = 0;                       ///< pixels
  std::size_t height = 0;                      ///< pixels
  std::vector<QuantizationTable> tables;       ///< those that the components name
  std::vector<QuantizedComponent> components;  ///< Y, or Y, Cb and Cr
  /// Coefficients that baseline JPEG cannot code and that were clamped, or were not numbers.
  std::uint64_t clamped = 0;

  /// \throws std::invalid_argument naming the fault when there are no pixels or no components, a
  ///         table holds a zero, or a component's sampling factors (1..4), table, number of blocks
  ///         or number of values do not fit the rest.
  FREQSYNTH_API void validate() const;
};

namespace detail {

/// Y of JPEG is shifted by -128, which is -8 * 128 in the constant coefficient (eq. 1).
inline constexpr float level_shift = 8 * 128;

/// Largest sampling factors among the components.
struct SamplingFactors {
  int horizontal = 1, vertical = 1;
};

[[nodiscard]] SamplingFactors largest_factors(const QuantizedImage& image);

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/quantized_image.inl"
#endif
