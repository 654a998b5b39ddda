// SPDX-License-Identifier: MIT
/// \file
/// Slow, obviously right computations that the library is compared with. Everything here is written
/// from the paper's equations in long double, and uses none of the library's own numerics.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace oracle {

using Real = long double;

/// Unit round-offs: the largest relative error of one rounding.
inline constexpr double float_rounding = 0x1p-24;
inline constexpr double double_rounding = 0x1p-53;

inline constexpr Real pi = std::numbers::pi_v<Real>;

// -------------------------------------------------------------------------------------- random

/// Numbers that are the same in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// A number in 0 .. count - 1.
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
  }
  float value() { return static_cast<float>(uniform(-1, 1)); }

  template <std::size_t N>
  std::array<float, N> values() {
    std::array<float, N> numbers;
    for (float& number : numbers) number = value();
    return numbers;
  }

  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

// --------------------------------------------------------------------------- cosine transform

/// Figure 6: row-major place v * 8 + u of each zig-zag term, the table that is printed in the JPEG
/// standard (ITU-T T.81, figure A.6).
inline constexpr std::array<int, 64> zigzag = {
    0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,   //
    12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6,  7,  14, 21, 28,  //
    35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,  //
    58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

inline int horizontal(std::size_t term) { return zigzag[term] % 8; }
inline int vertical(std::size_t term) { return zigzag[term] / 8; }

/// kappa of eqs. 1 and 2.
inline Real kappa(int frequency) { return frequency == 0 ? 1 / std::sqrt(Real{2}) : Real{1}; }

/// Amplitude G of a term whose coefficient F is 1 (eq. 6).
inline Real amplitude(std::size_t term) {
  return kappa(horizontal(term)) * kappa(vertical(term)) / 4;
}

/// The first `terms` cosine products at (s, t) (eq. 28).
inline std::vector<Real> term_values(Real s, Real t, std::size_t terms = 64) {
  std::array<Real, 8> across, down;
  for (int k = 0; k < 8; ++k) {
    across[static_cast<std::size_t>(k)] = std::cos(pi * static_cast<Real>(k) * s);
    down[static_cast<std::size_t>(k)] = std::cos(pi * static_cast<Real>(k) * t);
  }
  std::vector<Real> values(terms);
  for (std::size_t i = 0; i < terms; ++i) {
    values[i] = across[static_cast<std::size_t>(horizontal(i))] *
                down[static_cast<std::size_t>(vertical(i))];
  }
  return values;
}

/// Value at (s, t) of a block with coefficients F.
inline Real block_value(std::span<const float> coefficients, Real s, Real t) {
  const std::vector<Real> values = term_values(s, t, coefficients.size());
  Real sum = 0;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    sum += amplitude(i) * static_cast<Real>(coefficients[i]) * values[i];
  }
  return sum;
}

// ----------------------------------------------------------------------------- dense matrices

/// A square matrix.
class Matrix {
 public:
  explicit Matrix(std::size_t size) : size_(size), values_(size * size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  Real& operator()(std::size_t i, std::size_t j) { return values_[i * size_ + j]; }
  Real operator()(std::size_t i, std::size_t j) const { return values_[i * size_ + j]; }

  /// The leading size x size part.
  [[nodiscard]] Matrix leading(std::size_t size) const {
    Matrix part(size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) part(i, j) = (*this)(i, j);
    }
    return part;
  }

  /// Adds factor * a a^T.
  void add_outer(std::span<const Real> a, Real factor = 1) {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) (*this)(i, j) += factor * a[i] * a[j];
    }
  }

  /// Frobenius norm.
  [[nodiscard]] Real norm() const {
    Real sum = 0;
    for (const Real value : values_) sum += value * value;
    return std::sqrt(sum);
  }

 private:
  std::size_t size_;
  std::vector<Real> values_;
};

/// Solves M X = right by Gauss-Jordan elimination with row pivoting; `right` holds one row per row
/// of M, of any length, and becomes X.
inline void solve(Matrix m, std::vector<std::vector<Real>>& right) {
  const std::size_t n = m.size();
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column + 1; i < n; ++i) {
      if (std::abs(m(i, column)) > std::abs(m(pivot, column))) pivot = i;
    }
    if (m(pivot, column) == 0) throw std::domain_error("singular matrix");
    for (std::size_t j = 0; j < n; ++j) std::swap(m(pivot, j), m(column, j));
    std::swap(right[pivot], right[column]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == column) continue;
      const Real factor = m(i, column) / m(column, column);
      for (std::size_t j = column; j < n; ++j) m(i, j) -= factor * m(column, j);
      for (std::size_t j = 0; j < right[i].size(); ++j) right[i][j] -= factor * right[column][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (Real& value : right[i]) value /= m(i, i);
  }
}

inline Matrix inverse(const Matrix& m) {
  std::vector<std::vector<Real>> rows(m.size(), std::vector<Real>(m.size()));
  for (std::size_t i = 0; i < m.size(); ++i) rows[i][i] = 1;
  solve(m, rows);
  Matrix result(m.size());
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (std::size_t j = 0; j < m.size(); ++j) result(i, j) = rows[i][j];
  }
  return result;
}

/// What rounding to double can do to an inverse, relative to its norm: the rounding of its input
/// times the condition number, for each of the few operations that an update consists of.
inline Real inverse_tolerance(const Matrix& m, const Matrix& inverse) {
  return 8 * m.norm() * inverse.norm() * static_cast<Real>(double_rounding);
}

inline std::vector<Real> solve(const Matrix& m, std::span<const Real> right) {
  std::vector<std::vector<Real>> rows;
  for (std::size_t i = 0; i < m.size(); ++i) rows.push_back({right[i]});
  solve(m, rows);
  std::vector<Real> x;
  for (const auto& row : rows) x.push_back(row.front());
  return x;
}

/// True when sign * M + shift * identity is positive definite: Cholesky's factor exists (double is
/// enough, for it is asked with room to spare).
inline bool positive_definite(const Matrix& m, double sign, double shift) {
  const std::size_t n = m.size();
  std::vector<double> l(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = sign * static_cast<double>(m(i, j)) + (i == j ? shift : 0);
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      if (i != j) {
        l[i * n + j] = sum / l[j * n + j];
      } else if (!(sum > 0)) {
        return false;
      } else {
        l[i * n + i] = std::sqrt(sum);
      }
    }
  }
  return true;
}

// ------------------------------------------------------------------------------ least squares

/// The paper's fit (eqs. 21 to 25): all samples are kept, every solution is computed anew.
class LeastSquares {
 public:
  void add(Real s, Real t, Real value) {
    const std::vector<Real> a = term_values(s, t);
    normal_.add_outer(a);
    for (std::size_t i = 0; i < 64; ++i) right_[i] += value * a[i];
  }

  /// Amplitudes X of the first `terms` terms.
  [[nodiscard]] std::vector<Real> amplitudes(std::size_t terms) const {
    return solve(normal_.leading(terms), std::span<const Real>(right_).first(terms));
  }

  /// Coefficients F (eq. 26), zero beyond `terms`.
  [[nodiscard]] std::vector<Real> coefficients(std::size_t terms) const {
    std::vector<Real> f = amplitudes(terms);
    for (std::size_t i = 0; i < terms; ++i) f[i] /= amplitude(i);
    f.resize(64);
    return f;
  }

  [[nodiscard]] const Matrix& normal() const { return normal_; }

 private:
  Matrix normal_{64};
  std::array<Real, 64> right_{};
};

/// Mean squared difference of the 64 pixel values of two blocks, by eq. 2 at every pixel's centre.
inline Real mean_squared_pixel_change(std::span<const float> before, std::span<const float> after) {
  Real sum = 0;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const Real s = (static_cast<Real>(x) + Real{0.5}) / 8;
      const Real t = (static_cast<Real>(y) + Real{0.5}) / 8;
      const Real difference = block_value(after, s, t) - block_value(before, s, t);
      sum += difference * difference;
    }
  }
  return sum / 64;
}

}  // namespace oracle
