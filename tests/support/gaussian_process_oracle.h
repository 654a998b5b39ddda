// SPDX-License-Identifier: MIT
/// \file
/// Gaussian processes by dense linear algebra in long double.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/box_covariance.h"
#include "freqsynth/basis/covariance.h"
#include "support/covariance_oracle.h"
#include "support/oracles.h"

namespace oracle {

using Rows = std::vector<std::vector<Real>>;

/// Gaussian elimination with the largest pivot first; ln |det| besides.
inline Rows solve(Rows matrix, Rows right, Real* log_determinant = nullptr) {
  const std::size_t n = matrix.size();
  Real logarithm = 0;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
    }
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    logarithm += std::log(std::abs(matrix[k][k]));
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Real factor = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      for (std::size_t j = 0; j < right[i].size(); ++j) right[i][j] -= factor * right[k][j];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (Real& value : right[k]) value /= matrix[k][k];
  }
  if (log_determinant != nullptr) *log_determinant = logarithm;
  return right;
}

/// Universal kriging: the best linear unbiased estimate with an unknown level, by the bordered
/// system (K 1; 1' 0), and the likelihood of all differences of the samples.
struct GaussianProcess {
  std::vector<Real> means;
  std::vector<Real> variances;  ///< expected squared error of each
  Real variance = 0;            ///< mean expected squared error of the averages
  Real log_determinant = 0;     ///< of the covariance of the differences from the first sample
  Real quadratic = 0;           ///< of these differences

  GaussianProcess(const freqsynth::Covariance& kernel, std::span<const freqsynth::UnitPoint> at,
                  std::span<const double> values, const freqsynth::AverageGrid& grid) {
    const std::size_t n = at.size();
    const auto between = [&](std::size_t i, std::size_t j) {
      return covariance(kernel, Real{at[i].s} - at[j].s, Real{at[i].t} - at[j].t) +
             (i == j ? Real{kernel.noise} : Real{0});
    };
    Rows system(n + 1, std::vector<Real>(n + 1, 1)), right(n + 1);
    system[n][n] = 0;
    // Covariances with averages have tests of their own.
    const freqsynth::detail::BoxCovariance boxes(kernel, grid);
    std::vector<double> with_boxes(grid.count());
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) system[i][j] = between(i, j);
      boxes.with_point(at[i], with_boxes);
      right[i].assign(with_boxes.begin(), with_boxes.end());
    }
    right[n].assign(grid.count(), 1);
    const Rows weights = solve(system, right);
    const Real own = boxes.with_box({});
    for (std::size_t p = 0; p < grid.count(); ++p) {
      Real mean = 0, error = own;
      for (std::size_t i = 0; i < n; ++i) {
        mean += weights[i][p] * values[i];
        error -= weights[i][p] * right[i][p];
      }
      means.push_back(mean);
      variances.push_back(error - weights[n][p]);
      variance += variances.back() / static_cast<Real>(grid.count());
    }
    Rows differences(n - 1, std::vector<Real>(n - 1)), of_values(n - 1);
    for (std::size_t i = 1; i < n; ++i) {
      for (std::size_t j = 1; j < n; ++j) {
        differences[i - 1][j - 1] = between(i, j) - between(i, 0) - between(0, j) + between(0, 0);
      }
      of_values[i - 1] = {Real{values[i]} - values[0]};
    }
    const Rows solved = solve(differences, of_values, &log_determinant);
    for (std::size_t i = 1; i < n; ++i) quadratic += solved[i - 1][0] * of_values[i - 1][0];
  }
};

/// Draws of a process with the given covariance: noisy samples at points, and averages of
/// side x side pixels as means of fine x fine values in each.
class ProcessDraws {
 public:
  struct Draw {
    std::vector<double> samples, averages;
  };

  ProcessDraws(const freqsynth::Covariance& kernel, std::span<const freqsynth::UnitPoint> at,
               std::size_t side, std::size_t fine)
      : kernel_(kernel), samples_(at.size()), side_(side), fine_(fine) {
    std::vector<freqsynth::UnitPoint> all(at.begin(), at.end());
    const std::size_t lines = side * fine;
    for (std::size_t i = 0; i < lines * lines; ++i) {
      const auto middle = [&](std::size_t k) {
        return (static_cast<double>(k) + 0.5) / static_cast<double>(lines);
      };
      all.push_back({middle(i % lines), middle(i / lines)});
    }
    // Cholesky's factor.
    factor_.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      factor_[i].resize(i + 1);
      for (std::size_t j = 0; j <= i; ++j) {
        Real sum = covariance(kernel, Real{all[i].s} - all[j].s, Real{all[i].t} - all[j].t) +
                   (i == j ? 1e-9L : 0);
        for (std::size_t k = 0; k < j; ++k) sum -= Real{factor_[i][k]} * factor_[j][k];
        factor_[i][j] = static_cast<double>(i == j ? std::sqrt(sum) : sum / factor_[j][j]);
      }
    }
  }

  [[nodiscard]] Draw draw(unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> white(factor_.size()), values(factor_.size());
    for (double& one : white) one = normal(random);
    for (std::size_t i = 0; i < values.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) values[i] += factor_[i][j] * white[j];
    }
    Draw draw;
    draw.averages.resize(side_ * side_);
    for (std::size_t i = 0; i < samples_; ++i) {
      draw.samples.push_back(values[i] + std::sqrt(kernel_.noise) * normal(random));
    }
    const std::size_t lines = side_ * fine_;
    for (std::size_t i = 0; i < lines * lines; ++i) {
      const std::size_t pixel = i / lines / fine_ * side_ + i % lines / fine_;
      draw.averages[pixel] += values[samples_ + i] / static_cast<double>(fine_ * fine_);
    }
    return draw;
  }

 private:
  freqsynth::Covariance kernel_;
  std::size_t samples_, side_, fine_;
  std::vector<std::vector<double>> factor_;
};

}  // namespace oracle
