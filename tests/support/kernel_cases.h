// SPDX-License-Identifier: MIT
/// \file
/// Random arguments for the kernels, over all sizes that they take.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/kernels.h"
#include "support/oracles.h"

namespace freqsynth::kernel_cases {

using detail::AlignedVector;
using detail::BorderRow;
using detail::Kernels;
using detail::SampleRow;

/// Null if this processor, or this build, does not have them.
inline const Kernels* find(const std::string& name) {
  for (const Kernels* kernels : detail::runnable_kernels()) {
    if (kernels->name == name) return kernels;
  }
  return nullptr;
}

inline const Kernels& plain() { return *find("plain"); }

template <class T>
AlignedVector<T> random_numbers(std::size_t count, oracle::Random& random) {
  AlignedVector<T> numbers(count);
  for (T& number : numbers) number = static_cast<T>(random.uniform(-1, 1));
  return numbers;
}

/// A block about to absorb a sample: random numbers of the form that the kernel asks for.
struct Absorption {
  Absorption(std::size_t terms, std::size_t channel_count, bool with_border, bool with_values,
             oracle::Random& random)
      : channels(channel_count),
        states(random_numbers<float>((channels + 1) * max_terms, random)),
        sums(random_numbers<float>((channels + 1) * 2 * max_terms, random)),
        residuals(random_numbers<float>((channels + 1) * 2, random)),
        values(random_numbers<float>(channels + 1, random)),
        weights(random_numbers<float>(channels + 1, random)),
        known(with_values) {
    row.terms = static_cast<std::uint32_t>(terms);
    for (std::size_t i = 0; i < max_terms; ++i) {
      row.gain[i] = random.value();
      if (i < terms) row.fit[i] = random.value();
      if (i < terms) border.b[i] = random.value();
      if (i < terms) border.step[i] = random.value();
    }
    for (float* number : {&row.change, &row.residual, &border.inverse_delta, &border.change,
                          &border.cross, &border.delta}) {
      *number = static_cast<float>(random.uniform(0, 1));
    }
    row.pixel_count = std::array<std::uint8_t, 3>{1, 2, 4}[random.below(3)];
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      row.pixels[p] = static_cast<std::uint8_t>(16 * p + random.below(16));
      row.pixel_weights[p] = static_cast<float>(random.uniform(0, 1));
    }
    if (random.below(4) > 0) row.own_pixel = static_cast<std::uint8_t>(random.below(max_terms));
    if (random.below(4) > 0) row.own_share = static_cast<float>(random.uniform(0, 1));
    if (with_border) {
      border.step[terms] = 1;
      row.border = &border;
    }
    for (float& residual : residuals) residual = std::abs(residual);
  }

  void run(const Kernels& kernels) {
    kernels.absorb_samples(&row, 1, states.data(), sums.data(), residuals.data(),
                           known ? values.data() : nullptr, weights.data(), channels, &change);
  }

  SampleRow row;
  BorderRow border;
  std::size_t channels;
  // Of one channel more than there are, which must not change.
  AlignedVector<float> states, sums, residuals, values, weights;
  bool known;
  float change = 0;
};

/// Calls `each(make)` for all numbers of terms, channels, kinds of border and of values; make()
/// gives the same block every time.
template <class Each>
void for_all_absorptions(Each each) {
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    for (std::size_t channels = 0; channels <= 5; ++channels) {
      for (const bool border : {false, true}) {
        for (const bool values : {false, true}) {
          if (border && terms == max_terms) continue;
          SCOPED_TRACE(testing::Message() << terms << " terms, " << channels << " channels, border "
                                          << border << ", values " << values);
          const auto seed = static_cast<unsigned>(1000 * terms + 10 * channels + 2 * border);
          const auto make = [=] {
            oracle::Random random(seed);
            auto block = std::make_unique<Absorption>(terms, channels, border, values, random);
            return block;
          };
          each(make);
        }
      }
    }
  }
}

/// Matrices about to be updated. The inverse is none of `normal`, which the formula does not ask
/// for; both are near the identity, so that nothing cancels.
struct Update {
  Update(std::size_t t, std::size_t n, oracle::Random& random)
      : terms(t),
        normal_terms(n),
        inverse(max_terms * max_terms),
        normal(random_numbers<double>(max_terms * max_terms, random)),
        a(random_numbers<double>(n, random)) {
    for (std::size_t i = 0; i < max_terms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const double value = random.uniform(-0.01, 0.01) + (i == j ? 1 : 0);
        if (i < terms) inverse[i * max_terms + j] = inverse[j * max_terms + i] = value;
        normal[j * max_terms + i] = normal[i * max_terms + j];  // J is symmetric
      }
      normal[i * max_terms + i] += static_cast<double>(terms);
    }
  }

  void run(const Kernels& kernels) {
    kernels.rank_one_update(inverse.data(), normal.data(), a.data(), terms, normal_terms);
  }

  std::size_t terms, normal_terms;
  AlignedVector<double> inverse, normal, a;
};

template <class Each>
void for_all_updates(Each each) {
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    for (const std::size_t more : {0u, 1u, 2u, 3u, 5u, 9u, 64u}) {
      const std::size_t normal_terms = std::min(terms + more, max_terms);
      SCOPED_TRACE(testing::Message() << terms << " terms of " << normal_terms);
      each([=] {
        oracle::Random random(static_cast<unsigned>(100 * terms + more));
        return Update(terms, normal_terms, random);
      });
    }
  }
}

/// `count` random numbers, and zeros up to a multiple of 4.
inline AlignedVector<double> padded_numbers(std::size_t count, oracle::Random& random) {
  AlignedVector<double> numbers = random_numbers<double>(count, random);
  numbers.resize((count + 3) / 4 * 4);
  return numbers;
}

inline AlignedVector<double> outer_product(const Kernels& kernels, std::size_t terms) {
  oracle::Random random(static_cast<unsigned>(terms));
  AlignedVector<double> matrix = random_numbers<double>(max_terms * max_terms, random);
  const AlignedVector<double> x = padded_numbers(terms, random);
  kernels.add_outer_product(matrix.data(), x.data(), random.uniform(-1, 1), terms);
  return matrix;
}

struct Product {
  Product(const Kernels& kernels, std::size_t terms)
      : matrix(max_terms * max_terms), out(terms + 1, -7.0) {
    oracle::Random random(static_cast<unsigned>(terms));
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) matrix[i * max_terms + j] = random.uniform(-1, 1);
    }
    // Not aligned, and nothing readable beyond.
    x.resize(terms + 1);
    for (double& number : x) number = random.uniform(-1, 1);
    kernels.multiply(matrix.data(), x.data() + 1, terms, out.data());
  }

  AlignedVector<double> matrix, x, out;
};

struct Residuals {
  explicit Residuals(unsigned seed) : random(seed) {}

  void run(const Kernels& kernels) {
    kernels.residual_means(matrix.data(), amplitudes.data(), sums.data(), shares.data(),
                           out.data());
  }

  oracle::Random random;
  AlignedVector<float> matrix = random_numbers<float>(max_terms * max_terms, random);
  AlignedVector<float> amplitudes = random_numbers<float>(max_terms, random);
  AlignedVector<float> sums = random_numbers<float>(max_terms, random);
  AlignedVector<float> shares = random_numbers<float>(max_terms, random);
  AlignedVector<float> out = AlignedVector<float>(max_terms);
};

struct Separable {
  Separable(std::size_t c, std::size_t r)
      : columns(c), rows(r), stride(c + 8), random(static_cast<unsigned>(100 * c + r)) {}

  void run(const Kernels& kernels) {
    kernels.evaluate_separable(amplitudes.data(), wx.data(), stride, columns, wy.data(), rows,
                               out.data(), stride);
  }

  std::size_t columns, rows, stride;
  oracle::Random random;
  AlignedVector<float> amplitudes = random_numbers<float>(max_terms, random);
  AlignedVector<float> wx = random_numbers<float>(block_size * stride, random);
  AlignedVector<float> wy = random_numbers<float>(rows * block_size, random);
  AlignedVector<float> out = AlignedVector<float>(rows * stride, -7.0f);
};

template <class Each>
void for_all_sizes(Each each) {
  for (std::size_t columns = 8; columns <= 64; columns += 8) {
    for (const std::size_t rows : {0u, 1u, 2u, 7u, 8u, 16u, 33u}) {
      SCOPED_TRACE(testing::Message() << columns << " x " << rows);
      each(columns, rows);
    }
  }
}

}  // namespace freqsynth::kernel_cases
