// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/kernels.h"

namespace freqsynth {
namespace detail {

FREQSYNTH_INLINE double sinc(double z) {
  const double x = std::numbers::pi * z;
  return x == 0 ? 1 : std::sin(x) / x;
}

/// cos(pi u s) for u = 0..7.
inline std::array<double, block_size> cosines(double s) {
  std::array<double, block_size> values;
  for (std::size_t u = 0; u < block_size; ++u) {
    values[u] = std::cos(std::numbers::pi * static_cast<double>(u) * s);
  }
  return values;
}

/// Eq. 7 at the centres of the pixels of a block, as the separable kernel reads it.
struct PixelCosines {
  AlignedBlock by_frequency;  // [u][x]
  AlignedBlock by_pixel;      // [y][v]
  // The same cosines, [x][u], and the amplitudes of coefficients, [v][u], for the way there.
  AlignedArray<double, max_terms> forward, scales;

  PixelCosines() {
    for (std::size_t i = 0; i < max_terms; ++i) {
      scales[zigzag_to_row_major[i]] = amplitude_of_coefficient(i);
    }
    for (std::size_t x = 0; x < block_size; ++x) {
      const auto values = cosines((static_cast<double>(x) + 0.5) / block_size);
      for (std::size_t u = 0; u < block_size; ++u) {
        by_frequency[u * block_size + x] = by_pixel[x * block_size + u] =
            static_cast<float>(values[u]);
        forward[x * block_size + u] = double{by_pixel[x * block_size + u]};
      }
    }
  }
};

inline const PixelCosines& pixel_cosines() {
  static const PixelCosines table;
  return table;
}

FREQSYNTH_INLINE void transform_to_rows(std::span<const float, max_terms> pixels,
                                        std::span<float, max_terms> rows) {
  const PixelCosines& table = pixel_cosines();
  forward_transform(pixels.data(), table.forward.data(), table.scales.data(), rows.data());
}

FREQSYNTH_INLINE void evaluate_rows(std::span<const float, max_terms> amplitudes,
                                    std::span<float, max_terms> pixels) {
  const PixelCosines& table = pixel_cosines();
  evaluate_separable(amplitudes.data(), table.by_frequency.data(), block_size, block_size,
                     table.by_pixel.data(), block_size, pixels.data(), block_size);
}

}  // namespace detail

FREQSYNTH_INLINE void evaluate_terms(double s, double t, std::span<double> terms) {
  FREQSYNTH_ASSERT(terms.size() <= max_terms);
  const auto across = detail::cosines(s);
  const auto down = detail::cosines(t);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Frequency f = frequency_of_term(i);
    terms[i] = across[f.u] * down[f.v];
  }
}

FREQSYNTH_INLINE double pixel_mean_of_term(std::size_t term) {
  const Frequency f = frequency_of_term(term);
  return detail::sinc(f.u / 16.0) * detail::sinc(f.v / 16.0);
}

FREQSYNTH_INLINE void forward_dct(std::span<const float, max_terms> pixels,
                                  std::span<float, max_terms> coefficients) {
  detail::AlignedBlock rows;
  detail::transform_to_rows(pixels, rows);
  detail::to_zigzag(rows, coefficients);
}

FREQSYNTH_INLINE void inverse_dct(std::span<const float, max_terms> coefficients,
                                  std::span<float, max_terms> pixels, std::size_t terms) {
  if (terms == 0 || terms > max_terms) {
    detail::refuse("inverse_dct: terms is " + std::to_string(terms) + ", not in 1..64");
  }
  std::array<float, max_terms> amplitudes;
  for (std::size_t i = 0; i < max_terms; ++i) {
    amplitudes[i] = i < terms ? coefficients[i] * detail::coefficient_amplitudes[i] : 0;
  }
  detail::AlignedBlock rows, out;
  detail::to_row_major(amplitudes, rows);
  detail::evaluate_rows(rows, out);
  std::copy(out.begin(), out.end(), pixels.begin());
}

FREQSYNTH_INLINE double evaluate_block(std::span<const float, max_terms> coefficients, double s,
                                       double t) {
  std::array<double, max_terms> values;
  evaluate_terms(s, t, values);
  double sum = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    sum += amplitude_of_coefficient(i) * values[i] * double{coefficients[i]};
  }
  return sum;
}

}  // namespace freqsynth
