// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/normal_inverse.h"

namespace freqsynth {

FREQSYNTH_INLINE void rank_one_update(TermMatrix& inverse, TermMatrix& normal,
                                      std::span<const double> a, std::size_t terms) {
  if (terms == 0 || terms > a.size() || a.size() > max_terms) [[unlikely]] {
    detail::refuse("rank_one_update: terms is " + std::to_string(terms) + ", the term values are " +
                   std::to_string(a.size()) + ", not 1 <= terms <= term values <= 64");
  }
  detail::rank_one_update(inverse.values.data(), normal.values.data(), a.data(), terms, a.size());
}

namespace detail {

/// What the samples determine of a new term: J^-1 B, padded with zeros to whole vectors, and Delta
/// of eq. 37.
struct BorderSolution {
  AlignedArray<double, max_terms> rb;
  double delta = 0;

  BorderSolution(const TermMatrix& inverse, std::span<const double> b, double d) : delta(d) {
    multiply(inverse.values.data(), b.data(), b.size(), rb.data());
    for (std::size_t i = b.size(); i % 4 != 0; ++i) rb[i] = 0;
    for (std::size_t i = 0; i < b.size(); ++i) delta -= b[i] * rb[i];
  }

  void write_step(std::span<double> step, std::size_t terms) const {
    if (step.size() != terms) {
      refuse("border_inverse: step has " + std::to_string(step.size()) + " values, not the " +
             std::to_string(terms) + " of B");
    }
    for (std::size_t i = 0; i < terms; ++i) step[i] = -rb[i];
  }

  /// Eq. 37 itself.
  void extend(TermMatrix& inverse, std::size_t terms) const {
    const double scale = 1 / delta;
    add_outer_product(inverse.values.data(), rb.data(), scale, terms);
    for (std::size_t i = 0; i < terms; ++i) inverse(i, terms) = inverse(terms, i) = -rb[i] * scale;
    inverse(terms, terms) = scale;
  }
};

}  // namespace detail

FREQSYNTH_INLINE double border_inverse(TermMatrix& inverse, std::span<const double> b, double d,
                                       std::span<double> step) {
  if (b.empty() || b.size() >= max_terms) {
    detail::refuse("border_inverse: B has " + std::to_string(b.size()) + " values, not 1..63");
  }
  const detail::BorderSolution solution(inverse, b, d);
  solution.write_step(step, b.size());
  if (solution.delta > 0) solution.extend(inverse, b.size());
  return solution.delta;
}

FREQSYNTH_INLINE void NormalInverse::add_sample(std::span<const double, max_terms> a) {
  if (terms_ == 0) {
    // The first term is the constant one, which any sample determines.
    for (std::size_t i = 0; i < max_terms; ++i) {
      for (std::size_t j = 0; j < max_terms; ++j) normal_(i, j) = a[i] * a[j];
    }
    inverse_(0, 0) = 1 / normal_(0, 0);
    terms_ = 1;
  } else {
    rank_one_update(inverse_, normal_, a, terms_);
  }
  ++samples_;
}

FREQSYNTH_INLINE double NormalInverse::add_term(std::span<double> step, double tolerance) {
  if (terms_ == 0 || terms_ == max_terms) return 0;
  const std::span<const double> b(normal_.row(terms_), terms_);
  const double d = normal_(terms_, terms_);
  const detail::BorderSolution solution(inverse_, b, d);
  // A term that the samples do not determine leaves the inverse alone.
  if (!(solution.delta > 0 && solution.delta > tolerance * d)) return 0;
  solution.write_step(step, terms_);
  solution.extend(inverse_, terms_);
  ++terms_;
  return solution.delta;
}

}  // namespace freqsynth
