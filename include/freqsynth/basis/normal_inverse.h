// SPDX-License-Identifier: MIT
/// \file
/// The normal matrix J (eq. 22) and its inverse for a growing number of samples and terms: Powell's
/// rank-one update (eq. 33) and Frobenius bordering (eq. 37), in double, O(T^2) each.
#pragma once

#include <cstddef>
#include <span>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"

namespace freqsynth {

/// A square matrix of up to 64 x 64, row-major, with a fixed row stride of 64 and aligned rows.
/// Only the leading part that an operation names is meaningful; the rest is zero.
struct TermMatrix {
  /// All 64 rows.
  detail::AlignedArray<double, max_terms * max_terms> values{};

  /// Row i, 64 values.
  [[nodiscard]] double* row(std::size_t i) { return values.data() + i * max_terms; }
  /// Row i, 64 values.
  [[nodiscard]] const double* row(std::size_t i) const { return values.data() + i * max_terms; }
  /// The value in row i and column j.
  double& operator()(std::size_t i, std::size_t j) { return values[i * max_terms + j]; }
  /// The value in row i and column j.
  double operator()(std::size_t i, std::size_t j) const { return values[i * max_terms + j]; }
};

/// Replaces J by J + A A^T (eq. 29) and J^-1 by Powell's form of its inverse (eq. 33), which,
/// unlike that of Sherman and Morrison, uses J itself and so suppresses the accumulation of errors.
/// \param inverse  T x T inverse of the leading part of `normal`, T = terms
/// \param normal   J of at least T terms; its leading a.size() x a.size() part is updated
/// \param a        term values at the new sample's position, at least T of them
/// \throws std::invalid_argument when not 1 <= terms <= a.size() <= 64.
FREQSYNTH_API void rank_one_update(TermMatrix& inverse, TermMatrix& normal,
                                   std::span<const double> a, std::size_t terms);

/// Extends J^-1 by one row and column (eq. 37) for a new term.
/// \param inverse  T x T on entry, (T + 1) x (T + 1) on return, T = b.size()
/// \param b        the new term against each of the old ones, B of eq. 36
/// \param d        the new term against itself, D of eq. 36
/// \param step     T values, receives -J^-1 B: change of the old amplitudes per unit of the new one
/// \return Delta of eq. 37. When it is not positive (or NaN), the new term depends on the old ones
///         and the inverse is not changed.
/// \throws std::invalid_argument when b.size() is not in 1..63 or step.size() differs from it.
FREQSYNTH_API double border_inverse(TermMatrix& inverse, std::span<const double> b, double d,
                                    std::span<double> step);

/// J of all 64 terms, and the inverse of its leading T x T part (paper, 4.1.2 and 4.2).
class FREQSYNTH_API NormalInverse {
 public:
  /// Starts with no sample and no term. The first sample brings in the first term.
  NormalInverse() = default;

  /// Number of terms T in the inverse.
  [[nodiscard]] std::size_t terms() const { return terms_; }
  /// Number of samples added.
  [[nodiscard]] std::size_t samples() const { return samples_; }
  /// J of all 64 terms.
  [[nodiscard]] const TermMatrix& normal() const { return normal_; }
  /// J^-1, T x T.
  [[nodiscard]] const TermMatrix& inverse() const { return inverse_; }

  /// Adds a sample by its 64 term values (eqs. 29 and 33); the term values of any position do.
  void add_sample(std::span<const double, max_terms> a);

  /// Adds the next term (eq. 37) if the samples determine it.
  /// \param step       T values, receives -J^-1 B if the term is added; see border_inverse
  /// \param tolerance  smallest share Delta / D of the new term that must be independent of the old
  /// \return Delta, or 0 when the term was not added: all 64 are in, or Delta <= tolerance D.
  /// \throws std::invalid_argument when a term is to be added and step.size() is not T.
  double add_term(std::span<double> step, double tolerance = 1e-6);

 private:
  TermMatrix normal_;
  TermMatrix inverse_;
  std::size_t terms_ = 0;
  std::size_t samples_ = 0;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/normal_inverse.inl"
#endif
