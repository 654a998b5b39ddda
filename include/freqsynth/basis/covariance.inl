// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/rounding.h"

namespace freqsynth::detail {

// The mathematics library's functions differ in the last digit from one to another, and would so
// from one machine to another.

FREQSYNTH_ROUNDING FREQSYNTH_INLINE double exp_minus(double x) {
  FREQSYNTH_ROUNDING_BEGIN
  if (!(x < 700)) return 0;
  // exp(-x) = 2^-n exp(-r), |r| <= ln 2 / 2. The leading part of ln 2 has few digits, so that its
  // multiples are exact.
  constexpr double inverses[] = {0,       1,       1.0 / 2, 1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,
                                 1.0 / 7, 1.0 / 8, 1.0 / 9, 1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13};
  constexpr double leading = 0x1.62e42feep-1, rest = 0x1.a39ef35793c76p-33;
  const auto n = static_cast<std::int64_t>(x * std::numbers::log2e + 0.5);
  const auto turns = static_cast<double>(n);
  const double r = (x - turns * leading) - turns * rest;
  double sum = 1;
  // Divisions would take most of the time in which lists are built.
  for (std::size_t k = 13; k > 0; --k) sum = 1 - (r * inverses[k]) * sum;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(1023 - n) << 52);
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE double log_of(double x) {
  FREQSYNTH_ROUNDING_BEGIN
  // x = 2^n m with m around 1, and ln m = 2 artanh((m - 1) / (m + 1)).
  constexpr std::uint64_t below_root_half = 0x3fe6a09e667f3bccu;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto n = static_cast<std::int64_t>(bits - below_root_half) >> 52;
  const double m = std::bit_cast<double>(bits - (static_cast<std::uint64_t>(n) << 52));
  const double ratio = (m - 1) / (m + 1);
  const double square = ratio * ratio;
  double sum = 0;
  for (int k = 23; k > 0; k -= 2) sum = sum * square + 1.0 / k;
  return static_cast<double>(n) * std::numbers::ln2 + 2 * ratio * sum;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE double cos_turns(double turns) {
  FREQSYNTH_ROUNDING_BEGIN
  turns -= std::floor(turns + 0.5);
  turns = turns < 0 ? -turns : turns;
  const bool negative = turns > 0.25;
  if (negative) turns = 0.5 - turns;
  const double x = 2 * std::numbers::pi * turns;
  const double square = x * x;
  constexpr double inverses[] = {1.0 / 2,   1.0 / 12,  1.0 / 30,  1.0 / 56,  1.0 / 90, 1.0 / 132,
                                 1.0 / 182, 1.0 / 240, 1.0 / 306, 1.0 / 380, 1.0 / 462};
  double sum = 1;
  for (std::size_t k = std::size(inverses); k > 0; --k) {
    sum = 1 - (square * inverses[k - 1]) * sum;
  }
  return negative ? -sum : sum;
}

FREQSYNTH_INLINE CovarianceFunction::CovarianceFunction(const Covariance& covariance)
    : covariance_(covariance) {
  const auto in_range = [](double value, double low, double high) {
    return value >= low && value <= high;
  };
  require(covariance.shape <= CovarianceShape::squared_exponential, "shape",
          static_cast<double>(covariance.shape), "a CovarianceShape");
  require(in_range(covariance.along, 0.01, 1000), "along", covariance.along, "in 0.01..1000");
  require(in_range(covariance.across, 0.01, 1000), "across", covariance.across, "in 0.01..1000");
  require(in_range(covariance.angle, -100, 100), "angle", covariance.angle, "in -100..100");
  require(in_range(covariance.noise, 0, 1e6), "noise", covariance.noise, "in 0..1e6");
  const bool smooth = covariance.shape >= CovarianceShape::matern52;
  require(in_range(covariance.frequency, 0, smooth ? 16 : 0), "frequency", covariance.frequency,
          smooth ? "in 0..16" : "0, which it is for shapes that are not smooth");
  const double turns = covariance.angle * (0.5 / std::numbers::pi);
  cosine_ = cos_turns(turns);
  sine_ = cos_turns(turns - 0.25);
  const double factor = covariance.shape == CovarianceShape::matern32   ? std::sqrt(3.0)
                        : covariance.shape == CovarianceShape::matern52 ? std::sqrt(5.0)
                                                                        : 1;
  per_along_ = factor / covariance.along;
  per_across_ = factor / covariance.across;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE UnitPoint CovarianceFunction::scaled(UnitPoint d) const {
  FREQSYNTH_ROUNDING_BEGIN
  return {(cosine_ * d.s + sine_ * d.t) * per_along_, (cosine_ * d.t - sine_ * d.s) * per_across_};
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE double CovarianceFunction::operator()(UnitPoint d) const {
  FREQSYNTH_ROUNDING_BEGIN
  const UnitPoint at = scaled(d);
  const double square = at.s * at.s + at.t * at.t;
  if (covariance_.shape == CovarianceShape::squared_exponential) {
    const double envelope = exp_minus(0.5 * square);
    return covariance_.frequency == 0
               ? envelope
               : envelope * cos_turns(covariance_.frequency * (at.t / per_across_));
  }
  const double q = std::sqrt(square);
  double value = exp_minus(q);
  if (covariance_.shape == CovarianceShape::matern32) value *= 1 + q;
  if (covariance_.shape == CovarianceShape::matern52) value *= 1 + q + square * (1.0 / 3);
  if (covariance_.frequency != 0) {
    value *= cos_turns(covariance_.frequency * (at.t / per_across_));
  }
  return value;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE void CovarianceFunction::values(const double* s,
                                                                    const double* t,
                                                                    std::size_t count,
                                                                    double* out) const {
  FREQSYNTH_ROUNDING_BEGIN
  constexpr std::size_t most = 256;
  double squares[most], distances[most], turns[most];
  for (std::size_t first = 0; first < count; first += most) {
    const std::size_t some = std::min(most, count - first);
    double* const values = out + first;
    for (std::size_t i = 0; i < some; ++i) {
      const UnitPoint at = scaled({s[first + i], t[first + i]});
      squares[i] = at.s * at.s + at.t * at.t;
      turns[i] = at.t;
    }
    if (covariance_.shape == CovarianceShape::squared_exponential) {
      for (std::size_t i = 0; i < some; ++i) distances[i] = 0.5 * squares[i];
    } else {
      for (std::size_t i = 0; i < some; ++i) distances[i] = std::sqrt(squares[i]);
    }
    exponentials(distances, some, values);
    if (covariance_.shape == CovarianceShape::matern32) {
      for (std::size_t i = 0; i < some; ++i) values[i] *= 1 + distances[i];
    }
    if (covariance_.shape == CovarianceShape::matern52) {
      for (std::size_t i = 0; i < some; ++i) {
        values[i] *= 1 + distances[i] + squares[i] * (1.0 / 3);
      }
    }
    if (covariance_.frequency == 0) continue;
    for (std::size_t i = 0; i < some; ++i) {
      turns[i] = covariance_.frequency * (turns[i] / per_across_);
    }
    cosines(turns, some, turns);
    for (std::size_t i = 0; i < some; ++i) values[i] *= turns[i];
  }
}

}  // namespace freqsynth::detail
