// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <span>

#include "freqsynth/basis/dct.h"
#include "freqsynth/image/filter_kernel.h"

namespace freqsynth::detail {

/// Of the cosines of 0, 1, 2, 3 times pi t / r.
inline constexpr double blackman_harris_weights[] = {0.35875, 0.48829, 0.14128, 0.01168};

/// Spherical Bessel functions j_0 .. j_3 of z >= 0: half the integral over -1 .. 1 of a Legendre
/// polynomial times a cosine or sine of z x.
inline std::array<double, 4> spherical_bessel(double z) {
  std::array<double, 4> j;
  if (z < 3) {
    // Closed forms cancel there.
    double power = 1;
    for (std::size_t n = 0; n < 4; ++n) {
      double term = power, sum = power;
      for (int k = 1; std::abs(term) > 1e-18 * std::abs(sum); ++k) {
        term *= -0.5 * z * z / (k * (2.0 * static_cast<double>(n) + 2 * k + 1));
        sum += term;
      }
      j[n] = sum;
      power *= z / (2 * static_cast<double>(n) + 3);
    }
    return j;
  }
  j[0] = std::sin(z) / z;
  j[1] = (j[0] - std::cos(z)) / z;
  j[2] = 3 * j[1] / z - j[0];
  j[3] = 5 * j[2] / z - j[1];
  return j;
}

FREQSYNTH_INLINE FilterKernel::FilterKernel(PixelFilter filter, const PixelFilterShape& shape)
    : filter_(filter), radius_(filter_radius(filter, shape)), sigma_(shape.sigma) {
  if (filter == PixelFilter::box) {
    pieces_[0] = {1, {1}};
  } else if (filter == PixelFilter::tent) {
    pieces_[0] = {1, {1, -1}};
  } else if (filter == PixelFilter::mitchell) {
    // In x = 2 |t| / r the pieces are 0 .. 1 and 1 .. 2.
    const double b = shape.b, c = shape.c;
    pieces_[0] = {
        0.5, {(6 - 2 * b) / 6, 0, 4 * (-18 + 12 * b + 6 * c) / 6, 8 * (12 - 9 * b - 6 * c) / 6}};
    pieces_[1] = {1,
                  {(8 * b + 24 * c) / 6, 2 * (-12 * b - 48 * c) / 6, 4 * (6 * b + 30 * c) / 6,
                   8 * (-b - 6 * c) / 6}};
  }
}

FREQSYNTH_INLINE void FilterKernel::integrate(double begin, double end, double omega, double phase,
                                              std::span<double, block_size> sums) const {
  begin = std::max(begin, -radius_);
  end = std::min(end, radius_);
  if (begin >= end) return;
  if (filter_ == PixelFilter::gaussian) {
    const double fastest = static_cast<double>(block_size - 1) * std::abs(omega);
    visit_nodes(begin, end, fastest, [&](double t, double weight) {
      for (std::size_t u = 0; u < block_size; ++u) {
        sums[u] += weight * std::cos(static_cast<double>(u) * (omega * t + phase));
      }
    });
  } else if (filter_ == PixelFilter::blackman_harris) {
    add_cosines(begin, end, omega, phase, sums);
  } else {
    add_pieces(begin, end, omega, phase, sums);
  }
}

FREQSYNTH_INLINE void FilterKernel::add_pieces(double begin, double end, double omega, double phase,
                                               std::span<double, block_size> sums) const {
  double inner = 0;
  for (const Piece& piece : pieces_) {
    const double outer = piece.end * radius_;
    for (const double side : {-1.0, 1.0}) {
      const double low = std::max(begin, side < 0 ? -outer : inner);
      const double high = std::min(end, side < 0 ? -inner : outer);
      if (low >= high) continue;
      const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
      // The polynomial of x in -1 .. 1, |t| / r = m + h x, and its Legendre coefficients.
      const double m = side * middle / radius_, h = side * half / radius_;
      const double* const p = piece.coefficients;
      const double x0 = p[0] + m * (p[1] + m * (p[2] + m * p[3]));
      const double x1 = h * (p[1] + m * (2 * p[2] + m * 3 * p[3]));
      const double x2 = h * h * (p[2] + 3 * m * p[3]);
      const double x3 = h * h * h * p[3];
      const double even[] = {x0 + x2 / 3, -2 * x2 / 3};
      const double odd[] = {-(x1 + 3 * x3 / 5), 2 * x3 / 5};
      for (std::size_t u = 0; u < block_size; ++u) {
        const auto frequency = static_cast<double>(u);
        const auto j = spherical_bessel(frequency * omega * half);
        const double angle = frequency * (omega * middle + phase);
        sums[u] += 2 * half *
                   ((even[0] * j[0] + even[1] * j[2]) * std::cos(angle) +
                    (odd[0] * j[1] + odd[1] * j[3]) * std::sin(angle));
      }
    }
    inner = outer;
  }
}

FREQSYNTH_INLINE void FilterKernel::add_cosines(double begin, double end, double omega,
                                                double phase,
                                                std::span<double, block_size> sums) const {
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const double turn = std::numbers::pi / radius_;
  for (std::size_t u = 0; u < block_size; ++u) {
    const auto frequency = static_cast<double>(u);
    // A product of cosines is the mean of those of the sum and of the difference.
    for (int k = -3; k <= 3; ++k) {
      const double rate = frequency * omega + k * turn;
      sums[u] += (k == 0 ? 2 : 1) * blackman_harris_weights[std::abs(k)] * half *
                 std::cos(rate * middle + frequency * phase) * sinc(rate * half / std::numbers::pi);
    }
  }
}

FREQSYNTH_INLINE double FilterKernel::value(double t) const {
  const double x = std::abs(t) / radius_;
  if (filter_ == PixelFilter::gaussian) {
    // exp(-t^2 / ..) - exp(-r^2 / ..) without cancellation.
    const double square = 0.5 / (sigma_ * sigma_);
    return -std::exp(-square * t * t) * std::expm1(-square * (radius_ - t) * (radius_ + t));
  }
  if (filter_ == PixelFilter::blackman_harris) {
    double sum = 0;
    for (int k = 0; k < 4; ++k)
      sum += blackman_harris_weights[k] * std::cos(k * std::numbers::pi * x);
    return sum;
  }
  const double* const p = pieces_[x < pieces_[0].end ? 0 : 1].coefficients;
  return p[0] + x * (p[1] + x * (p[2] + x * p[3]));
}

}  // namespace freqsynth::detail
