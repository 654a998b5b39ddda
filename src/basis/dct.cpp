#include "freqsynth/basis/dct.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/kernels.h"

namespace freqsynth {
namespace {

/// cos(pi u s) for u = 0..7.
std::array<double, block_size> cosines(double s) {
  std::array<double, block_size> values;
  for (std::size_t u = 0; u < block_size; ++u) {
    values[u] = std::cos(std::numbers::pi * static_cast<double>(u) * s);
  }
  return values;
}

/// Eq. 7 at the centres of the pixels of a block, as the separable kernel reads it.
struct PixelCosines {
  alignas(32) float by_frequency[block_size][block_size];  // [u][x]
  alignas(32) float by_pixel[block_size][block_size];      // [y][v]

  float amplitude[max_terms];  // of a coefficient, zig-zag

  PixelCosines() {
    for (std::size_t i = 0; i < max_terms; ++i) {
      amplitude[i] = static_cast<float>(amplitude_of_coefficient(i));
    }
    for (std::size_t x = 0; x < block_size; ++x) {
      const auto values = cosines((static_cast<double>(x) + 0.5) / block_size);
      for (std::size_t u = 0; u < block_size; ++u) {
        by_frequency[u][x] = by_pixel[x][u] = static_cast<float>(values[u]);
      }
    }
  }
};

const PixelCosines& pixel_cosines() {
  static const PixelCosines table;
  return table;
}

}  // namespace

void evaluate_terms(double s, double t, std::span<double> terms) {
  FREQSYNTH_ASSERT(terms.size() <= max_terms);
  const auto across = cosines(s);
  const auto down = cosines(t);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Frequency f = frequency_of_term(i);
    terms[i] = across[f.u] * down[f.v];
  }
}

double pixel_mean_of_term(std::size_t term) {
  const auto sinc = [](double z) {
    return z == 0 ? 1 : std::sin(std::numbers::pi * z) / (std::numbers::pi * z);
  };
  const Frequency f = frequency_of_term(term);
  return sinc(f.u / 16.0) * sinc(f.v / 16.0);
}

void forward_dct(std::span<const float, max_terms> pixels,
                 std::span<float, max_terms> coefficients) {
  const PixelCosines& table = pixel_cosines();
  double rows[block_size][block_size] = {};  // [y][u]
  for (std::size_t y = 0; y < block_size; ++y) {
    for (std::size_t u = 0; u < block_size; ++u) {
      for (std::size_t x = 0; x < block_size; ++x) {
        rows[y][u] += double{pixels[y * block_size + x]} * double{table.by_frequency[u][x]};
      }
    }
  }
  for (std::size_t i = 0; i < max_terms; ++i) {
    const Frequency f = frequency_of_term(i);
    double sum = 0;
    for (std::size_t y = 0; y < block_size; ++y) {
      sum += rows[y][f.u] * double{table.by_pixel[y][f.v]};
    }
    coefficients[i] = static_cast<float>(amplitude_of_coefficient(i) * sum);
  }
}

void inverse_dct(std::span<const float, max_terms> coefficients, std::span<float, max_terms> pixels,
                 std::size_t terms) {
  if (terms == 0 || terms > max_terms) {
    throw std::invalid_argument("freqsynth: inverse_dct: terms is " + std::to_string(terms) +
                                ", not in 1..64");
  }
  const PixelCosines& table = pixel_cosines();
  alignas(32) float amplitudes[max_terms];
  for (std::size_t place = 0; place < max_terms; ++place) {
    const std::size_t term = detail::row_major_to_zigzag[place];
    amplitudes[place] = term < terms ? coefficients[term] * table.amplitude[term] : 0;
  }
  alignas(32) float out[max_terms];
  detail::evaluate_separable(amplitudes, table.by_frequency[0], block_size, block_size,
                             table.by_pixel[0], block_size, out, block_size);
  for (std::size_t i = 0; i < max_terms; ++i) pixels[i] = out[i];
}

double evaluate_block(std::span<const float, max_terms> coefficients, double s, double t) {
  std::array<double, max_terms> values;
  evaluate_terms(s, t, values);
  double sum = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    sum += amplitude_of_coefficient(i) * values[i] * double{coefficients[i]};
  }
  return sum;
}

}  // namespace freqsynth
