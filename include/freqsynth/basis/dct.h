// SPDX-License-Identifier: MIT
/// \file
/// The Discrete Cosine Transform of an 8 x 8 block (paper, section 2): terms at any point, zig-zag
/// order, forward and inverse transform.
///
/// Coordinates: the unit block (s, t) in [0,1]^2, s to the right, t downwards. Pixel column x of
/// the block is centred at s = (x + 0.5) / 8, so that eq. 7 becomes C(x,u) = cos(pi u s).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Horizontal frequency u and vertical frequency v of a term, each 0..7 half cycles per block.
struct Frequency {
  std::uint8_t u = 0;  ///< horizontal
  std::uint8_t v = 0;  ///< vertical
};

/// Frequency of zig-zag term `term` (0..63), the order of figure 6: (0,0), (1,0), (0,1), (0,2), ...
[[nodiscard]] constexpr Frequency frequency_of_term(std::size_t term);

/// Zig-zag number (0..63) of the term with horizontal frequency u and vertical frequency v.
[[nodiscard]] constexpr std::size_t term_of_frequency(std::size_t u, std::size_t v);

/// kappa(u) kappa(v) / 4 of eq. 6: the factor that turns the coefficient F of eqs. 1 and 2 into the
/// amplitude G of the plain cosine product. `term` is a zig-zag number.
[[nodiscard]] constexpr double amplitude_of_coefficient(std::size_t term);

/// Mean of zig-zag term `term` over a pixel, relative to its value at the pixel's centre: sinc(u /
/// 16) sinc(v / 16) with sinc(z) = sin(pi z) / (pi z), the same for all pixels of the block.
[[nodiscard]] FREQSYNTH_API double pixel_mean_of_term(std::size_t term);

/// Writes cos(pi u s) cos(pi v t) (eq. 28) of the first `terms.size()` (at most 64) zig-zag terms.
/// (s, t) may lie anywhere, also outside the block, where the even periodic extension is meant.
FREQSYNTH_API void evaluate_terms(double s, double t, std::span<double> terms);

/// Forward transform (eq. 1): 64 pixel values, row by row, to 64 coefficients F in zig-zag order.
FREQSYNTH_API void forward_dct(std::span<const float, max_terms> pixels,
                               std::span<float, max_terms> coefficients);

/// Inverse transform (eq. 2; eq. 34 for fewer terms): the first `terms` (1..64) coefficients F in
/// zig-zag order to 64 pixel values at the pixels' centres, row by row. Later ones count as zero.
/// \throws std::invalid_argument when `terms` is not in 1..64.
FREQSYNTH_API void inverse_dct(std::span<const float, max_terms> coefficients,
                               std::span<float, max_terms> pixels, std::size_t terms = max_terms);

/// Value at (s, t) of the block with coefficients F in zig-zag order: eq. 2 at any point.
[[nodiscard]] FREQSYNTH_API double evaluate_block(std::span<const float, max_terms> coefficients,
                                                  double s, double t);

// ------------------------------------------------------------------------------------ definitions

namespace detail {

/// sin(pi z) / (pi z).
[[nodiscard]] double sinc(double z);

/// Zig-zag term number -> row-major position v * 8 + u, walked along the anti-diagonals.
constexpr std::array<std::uint8_t, max_terms> make_zigzag() {
  std::array<std::uint8_t, max_terms> order{};
  std::size_t term = 0;
  for (std::size_t diagonal = 0; diagonal < 2 * block_size - 1; ++diagonal) {
    for (std::size_t step = 0; step <= diagonal; ++step) {
      // Even diagonals are walked upwards (u grows), odd ones downwards.
      const std::size_t u = diagonal % 2 == 0 ? step : diagonal - step;
      const std::size_t v = diagonal - u;
      if (u < block_size && v < block_size) {
        order[term++] = static_cast<std::uint8_t>(v * block_size + u);
      }
    }
  }
  return order;
}

inline constexpr std::array<std::uint8_t, max_terms> zigzag_to_row_major = make_zigzag();

constexpr std::array<std::uint8_t, max_terms> invert_zigzag() {
  std::array<std::uint8_t, max_terms> inverse{};
  for (std::size_t term = 0; term < max_terms; ++term) {
    inverse[zigzag_to_row_major[term]] = static_cast<std::uint8_t>(term);
  }
  return inverse;
}

inline constexpr std::array<std::uint8_t, max_terms> row_major_to_zigzag = invert_zigzag();

inline constexpr double inverse_sqrt2 = 0.70710678118654752440;

/// kappa(u) of eqs. 1 and 2.
constexpr double kappa(std::size_t frequency) { return frequency == 0 ? inverse_sqrt2 : 1.0; }

}  // namespace detail

constexpr Frequency frequency_of_term(std::size_t term) {
  const std::uint8_t place = detail::zigzag_to_row_major[term];
  return {static_cast<std::uint8_t>(place % block_size),
          static_cast<std::uint8_t>(place / block_size)};
}

constexpr std::size_t term_of_frequency(std::size_t u, std::size_t v) {
  return detail::row_major_to_zigzag[v * block_size + u];
}

constexpr double amplitude_of_coefficient(std::size_t term) {
  const Frequency f = frequency_of_term(term);
  return 0.25 * detail::kappa(f.u) * detail::kappa(f.v);
}

namespace detail {

/// amplitude_of_coefficient() of all terms.
inline constexpr std::array<float, max_terms> coefficient_amplitudes = [] {
  std::array<float, max_terms> amplitudes{};
  for (std::size_t i = 0; i < max_terms; ++i) {
    amplitudes[i] = static_cast<float>(amplitude_of_coefficient(i));
  }
  return amplitudes;
}();
/// The same row by row, at place v * 8 + u.
inline constexpr std::array<float, max_terms> row_major_amplitudes = [] {
  std::array<float, max_terms> amplitudes{};
  for (std::size_t i = 0; i < max_terms; ++i) {
    amplitudes[zigzag_to_row_major[i]] = coefficient_amplitudes[i];
  }
  return amplitudes;
}();

/// Numbers of all terms from zig-zag order to rows. `rows` is none of `terms`.
inline void to_row_major(std::span<const float, max_terms> terms,
                         std::span<float, max_terms> rows) {
  // Unrolled, with places that are constants.
  [&]<std::size_t... place>(std::index_sequence<place...>) {
    ((rows[place] = terms[row_major_to_zigzag[place]]), ...);
  }
  (std::make_index_sequence<max_terms>());
}
/// The way back.
inline void to_zigzag(std::span<const float, max_terms> rows, std::span<float, max_terms> terms) {
  [&]<std::size_t... term>(std::index_sequence<term...>) {
    ((terms[term] = rows[zigzag_to_row_major[term]]), ...);
  }
  (std::make_index_sequence<max_terms>());
}

// Both transforms without zig-zag order. What is written is aligned to 32 bytes, as amplitudes are.
/// Eq. 1: coefficients F, row by row.
FREQSYNTH_API void transform_to_rows(std::span<const float, max_terms> pixels,
                                     std::span<float, max_terms> rows);
/// Eq. 2, of amplitudes G, row by row.
FREQSYNTH_API void evaluate_rows(std::span<const float, max_terms> amplitudes,
                                 std::span<float, max_terms> pixels);

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/dct.inl"
#endif
