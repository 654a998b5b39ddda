// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/innovation_list.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/rounding.h"

namespace freqsynth {

/// Who grows the list, and the numbers of its rows, step by step.
struct InnovationList::Growth {
  std::mutex growing;
  std::vector<detail::AlignedVector<float>> numbers;
};

/// The first n rows, in double. Those of fewer rows come out the same to the bit, so that a step of
/// growth begins anew rather than keep all this.
struct InnovationList::Factorization {
  Factorization(const detail::BoxCovariance& boxes, std::span<const UnitPoint> points);

  /// From the diagonal downwards.
  double* column(std::size_t j) { return factor.data() + j * (2 * n - j + 1) / 2; }
  double* gain(std::size_t i) { return gains.data() + i * averages; }

  std::size_t n, averages;
  std::vector<double> factor;  // packed columns of L; pivots on the diagonal, 0 where none is
  std::vector<double> gains;

 private:
  void set_covariances(const detail::BoxCovariance& boxes, std::span<const UnitPoint> points);
  void decompose(double variance);
};

FREQSYNTH_ROUNDING FREQSYNTH_INLINE InnovationList::Factorization::Factorization(
    const detail::BoxCovariance& boxes, std::span<const UnitPoint> points)
    : n(points.size()),
      averages(boxes.grid().count()),
      factor(n * (n + 1) / 2),
      gains(n * averages) {
  FREQSYNTH_ROUNDING_BEGIN
  set_covariances(boxes, points);
  decompose(1 + boxes.function().covariance().noise);
  std::fill(column(0), column(0) + n, 1.0);
  std::fill(gain(0), gain(0) + averages, 1.0);
}

/// Those of differences from the first sample, which know nothing of the level.
FREQSYNTH_ROUNDING inline void InnovationList::Factorization::set_covariances(
    const detail::BoxCovariance& boxes, std::span<const UnitPoint> points) {
  FREQSYNTH_ROUNDING_BEGIN
  const detail::CovarianceFunction& function = boxes.function();
  const double noise = function.covariance().noise;
  const double own = 1 + noise;
  std::vector<double> s(n), t(n), with_first(n);
  // From point j to those from it on.
  const auto set_values = [&](std::size_t j, double* values) {
    for (std::size_t i = j; i < n; ++i) {
      s[i] = points[i].s - points[j].s;
      t[i] = points[i].t - points[j].t;
    }
    function.values(&s[j], &t[j], n - j, values);
  };
  set_values(0, with_first.data());
  for (std::size_t i = 0; i < n; ++i) boxes.with_point(points[i], {gain(i), averages});
  for (std::size_t j = 1; j < n; ++j) {
    double* values = column(j);
    set_values(j, values);
    for (std::size_t i = j; i < n; ++i) {
      values[i - j] = (values[i - j] - with_first[i]) + (own - with_first[j]);
    }
    values[0] += noise;
  }
  for (std::size_t i = n; i-- > 1;) {
    for (std::size_t p = 0; p < averages; ++p) {
      gain(i)[p] = (gain(i)[p] - gain(0)[p]) + (own - with_first[i]);
    }
  }
}

/// Cholesky's factor, column by column, and L^-1 applied to the covariances with the averages.
FREQSYNTH_ROUNDING inline void InnovationList::Factorization::decompose(double variance) {
  FREQSYNTH_ROUNDING_BEGIN
  // What is left of the variance of a sample that those before it tell, is rounding.
  const double nothing = 1e-13 * variance;
  for (std::size_t j = 1; j < n; ++j) {
    double* own = column(j);
    if (!(own[0] > nothing)) {
      std::fill(own, own + (n - j), 0.0);
      std::fill(gain(j), gain(j) + averages, 0.0);
      continue;
    }
    const double pivot = std::sqrt(own[0]);
    own[0] = pivot;
    for (std::size_t i = j + 1; i < n; ++i) own[i - j] /= pivot;
    for (std::size_t p = 0; p < averages; ++p) gain(j)[p] /= pivot;
    for (std::size_t i = j + 1; i < n; ++i) {
      const double factor_ij = own[i - j];
      detail::add_scaled(own + (i - j), -factor_ij, n - i, column(i));
      detail::add_scaled(gain(j), -factor_ij, averages, gain(i));
    }
  }
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE InnovationList::InnovationList(
    const Covariance& covariance, std::span<const UnitPoint> positions, const AverageGrid& grid)
    : boxes_(covariance, grid), positions_(positions.begin(), positions.end()) {
  FREQSYNTH_ROUNDING_BEGIN
  detail::require(!positions.empty() && positions.size() <= max_positions, "positions.size()",
                  static_cast<double>(positions.size()), "in 1..2048");
  for (const UnitPoint& point : positions) {
    for (const double place : {point.s, point.t}) {
      detail::require(place >= -4 && place <= 5, "position", place, "in -4..5");
    }
  }
  std::vector<double> with_first(grid.count());
  boxes_.with_point(positions[0], with_first);
  const double box = boxes_.with_box({}), own = 1 + covariance.noise;
  for (const double with_box : with_first) {
    first_variances_.push_back((box - with_box) + (own - with_box));
  }
  rows_.resize(positions.size());
  growth_ = new Growth;
}

FREQSYNTH_INLINE InnovationList::~InnovationList() { delete growth_; }

FREQSYNTH_INLINE void InnovationList::reserve(std::size_t count) const {
  if (count > size()) grow(count);
}

FREQSYNTH_INLINE std::size_t InnovationList::memory() const {
  const std::lock_guard lock(growth_->growing);
  std::size_t bytes = rows_.size() * sizeof(InnovationRow);
  for (const auto& numbers : growth_->numbers) bytes += numbers.size() * sizeof(float);
  return bytes;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE void InnovationList::grow(std::size_t count) const {
  FREQSYNTH_ROUNDING_BEGIN
  // A count of 0 comes from the largest index there is, plus 1.
  if (count == 0 || count > positions_.size()) {
    detail::refuse("an innovation list of " + std::to_string(count) + " rows exceeds " +
                   std::to_string(positions_.size()));
  }
  const std::lock_guard lock(growth_->growing);
  const std::size_t first = size();
  if (first >= count) return;
  // By half at least: all steps together then take little more than the last.
  const std::size_t end =
      std::min(positions_.size(), std::max({count, first + first / 2, std::size_t{25}}));
  Factorization exact(boxes_, std::span(positions_).first(end));
  constexpr std::size_t lanes = 8;
  const auto padded = [](std::size_t size) { return (size + lanes - 1) / lanes * lanes; };
  const std::size_t averages = grid().count(), row_of_gains = padded(averages);
  std::size_t room = 0;
  for (std::size_t i = first; i < end; ++i) room += padded(i) + row_of_gains;
  detail::AlignedVector<float> numbers(room);
  growth_->numbers.reserve(growth_->numbers.size() + 1);
  float* next = numbers.data();
  double variance = 0, log_determinant = 0;
  for (const double first_variance : first_variances_) variance += first_variance;
  variance /= static_cast<double>(grid().count());
  for (std::size_t i = 0; i < end; ++i) {
    const double pivot = exact.column(i)[0];
    const double* gains = exact.gain(i);
    if (i > 0) {
      double squares = 0;
      for (std::size_t p = 0; p < averages; ++p) squares += gains[p] * gains[p];
      variance -= squares / static_cast<double>(averages);
      if (pivot > 0) log_determinant += 2 * detail::log_of(pivot);
    }
    if (i < first) continue;
    for (std::size_t j = 0; j < i; ++j) next[j] = static_cast<float>(exact.column(j)[i - j]);
    InnovationRow& row = rows_[i];
    row.factor = {next, i};
    next += padded(i);
    for (std::size_t p = 0; p < averages; ++p) next[p] = static_cast<float>(gains[p]);
    row.gains = {next, averages};
    next += row_of_gains;
    row.inverse_pivot = pivot > 0 ? static_cast<float>(1 / pivot) : 0;
    row.variance = static_cast<float>(std::max(variance, 0.0));
    row.log_determinant = log_determinant;
  }
  growth_->numbers.push_back(std::move(numbers));
  size_.store(end, std::memory_order_release);
}

FREQSYNTH_INLINE std::vector<UnitPoint> sequence_points(SampleSequence& sequence,
                                                        std::size_t count) {
  std::vector<UnitPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = {sequence[i].s, sequence[i].t};
  return points;
}

}  // namespace freqsynth
