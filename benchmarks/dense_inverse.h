// SPDX-License-Identifier: MIT
/// \file
/// The competitor of the updates of J^-1: the inverse computed anew, by textbook Cholesky.
#pragma once

#include <cmath>
#include <cstddef>

#include "freqsynth/basis/normal_inverse.h"

namespace freqsynth::bench {

/// inverse = normal^-1 of the leading terms x terms part of a symmetric positive definite matrix.
/// All inner loops run along rows and have no sums, so that the compiler can use vectors.
inline void invert_by_cholesky(const TermMatrix& normal, std::size_t terms, TermMatrix& inverse) {
  // U^T U = J, row by row, in the upper triangle.
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = i; j < terms; ++j) inverse(i, j) = normal(i, j);
  }
  for (std::size_t k = 0; k < terms; ++k) {
    double* pivot = inverse.row(k);
    const double scale = 1 / std::sqrt(pivot[k]);
    for (std::size_t j = k; j < terms; ++j) pivot[j] *= scale;
    for (std::size_t i = k + 1; i < terms; ++i) {
      double* row = inverse.row(i);
      const double factor = pivot[i];
      for (std::size_t j = i; j < terms; ++j) row[j] -= factor * pivot[j];
    }
  }
  // W = U^-T, row by row, in the lower triangle.
  for (std::size_t i = 0; i < terms; ++i) {
    double* row = inverse.row(i);
    const double scale = 1 / row[i];
    for (std::size_t j = 0; j < i; ++j) row[j] = 0;
    row[i] = scale;
    for (std::size_t k = 0; k < i; ++k) {
      const double* known = inverse.row(k);
      const double factor = known[i] * scale;
      for (std::size_t j = 0; j <= k; ++j) row[j] -= factor * known[j];
    }
  }
  // J^-1 = W^T W, and its mirror image.
  for (std::size_t i = 0; i < terms; ++i) {
    double* row = inverse.row(i);
    const double own = row[i];
    for (std::size_t j = 0; j <= i; ++j) row[j] *= own;
    for (std::size_t k = i + 1; k < terms; ++k) {
      const double* later = inverse.row(k);
      const double factor = later[i];
      for (std::size_t j = 0; j <= i; ++j) row[j] += factor * later[j];
    }
    for (std::size_t j = 0; j < i; ++j) inverse(j, i) = row[j];
  }
}

}  // namespace freqsynth::bench
