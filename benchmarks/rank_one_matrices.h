// SPDX-License-Identifier: MIT
/// \file
/// What the benchmarks of the updates of J^-1 share: J and J^-1 as the library and as Eigen store
/// them, and the inverse computed anew by LAPACK.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#ifdef FREQSYNTH_BENCH_EIGEN
#include <Eigen/Dense>
#endif

#include "dense_inverse.h"
#include "fixtures.h"
#include "freqsynth/basis/normal_inverse.h"

#ifdef FREQSYNTH_BENCH_LAPACK
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);
// Of OpenBLAS only. Its threads make matrices of this size slower.
void openblas_set_num_threads(int threads) __attribute__((weak));
}
#endif

namespace freqsynth::bench {

/// J and J^-1 as the library stores them.
struct Matrices {
  TermMatrix normal, inverse;

  explicit Matrices(std::size_t terms) : normal(*normal_matrix(terms)) {
    invert_by_cholesky(normal, terms, inverse);
  }
  [[nodiscard]] double normal_at(std::size_t i, std::size_t j) const { return normal(i, j); }
  [[nodiscard]] double inverse_at(std::size_t i, std::size_t j) const { return inverse(i, j); }
  void add_to_normal(const double* a, std::size_t terms) {
    for (std::size_t i = 0; i < terms; ++i) {
      double* row = normal.row(i);
      for (std::size_t j = 0; j < terms; ++j) row[j] += a[i] * a[j];
    }
  }
};

/// Largest entry of J J^-1 - 1.
template <class M>
double residual(const M& m, std::size_t terms) {
  double worst = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j < terms; ++j) {
      double sum = i == j ? -1 : 0;
      for (std::size_t k = 0; k < terms; ++k) sum += m.normal_at(i, k) * m.inverse_at(k, j);
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

#ifdef FREQSYNTH_BENCH_LAPACK
/// Matrices that LAPACK is to invert, in one thread.
struct LapackMatrices : Matrices {
  explicit LapackMatrices(std::size_t terms) : Matrices(terms) {
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  }
};

inline void invert_by_lapack(const TermMatrix& normal, std::size_t terms, TermMatrix& inverse) {
  constexpr int stride = max_terms;
  const int n = static_cast<int>(terms);
  int info = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    std::copy_n(normal.row(i), terms, inverse.row(i));
  }
  // Column-major "L" is the upper triangle of these rows.
  dpotrf_("L", &n, inverse.row(0), &stride, &info);
  dpotri_("L", &n, inverse.row(0), &stride, &info);
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j < i; ++j) inverse(i, j) = inverse(j, i);
  }
}
#endif

#ifdef FREQSYNTH_BENCH_EIGEN
inline constexpr int capacity = max_terms;
using EigenMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, capacity, capacity>;
using EigenVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, capacity, 1>;

inline EigenMatrix to_eigen(const TermMatrix& matrix, std::size_t terms) {
  const auto n = static_cast<Eigen::Index>(terms);
  return Eigen::Map<const EigenMatrix, 0, Eigen::OuterStride<>>(matrix.row(0), n, n,
                                                                Eigen::OuterStride<>(capacity));
}

struct EigenMatrices {
  EigenMatrix normal, inverse;
  EigenVector gamma, h, w;

  explicit EigenMatrices(std::size_t terms) {
    const auto start = std::make_unique<Matrices>(terms);
    normal = to_eigen(start->normal, terms);
    inverse = to_eigen(start->inverse, terms);
    gamma = h = w = EigenVector::Zero(normal.rows());
  }
  [[nodiscard]] double normal_at(std::size_t i, std::size_t j) const {
    return normal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  [[nodiscard]] double inverse_at(std::size_t i, std::size_t j) const {
    return inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
};
#endif

}  // namespace freqsynth::bench
