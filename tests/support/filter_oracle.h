// SPDX-License-Identifier: MIT
/// \file
/// Pixel filters from their definitions, and slow integrals of them in long double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "freqsynth/image/pixel_filter.h"
#include "support/oracles.h"

namespace oracle {

inline Real filter_radius(freqsynth::PixelFilter filter, const freqsynth::PixelFilterShape& shape) {
  constexpr Real usual[] = {0, 0.5L, 1, 1.5L, 1.5L, 2};
  return shape.radius > 0 ? static_cast<Real>(shape.radius)
                          : usual[static_cast<std::size_t>(filter)];
}

/// The weight at distance t, not normalised.
inline Real filter_value(freqsynth::PixelFilter filter, const freqsynth::PixelFilterShape& shape,
                         Real t) {
  using freqsynth::PixelFilter;
  const Real r = filter_radius(filter, shape);
  t = std::abs(t);
  if (t > r) return 0;
  if (filter == PixelFilter::box) return 1;
  if (filter == PixelFilter::tent) return 1 - t / r;
  if (filter == PixelFilter::gaussian) {
    const Real square = 2 * static_cast<Real>(shape.sigma) * static_cast<Real>(shape.sigma);
    return std::exp(-t * t / square) - std::exp(-r * r / square);
  }
  if (filter == PixelFilter::blackman_harris) {
    // As printed for a window of 0 .. 1.
    const Real turn = 2 * pi * (t / r + 1) / 2;
    return 0.35875L - 0.48829L * std::cos(turn) + 0.14128L * std::cos(2 * turn) -
           0.01168L * std::cos(3 * turn);
  }
  const Real x = 2 * t / r, b = static_cast<Real>(shape.b), c = static_cast<Real>(shape.c);
  if (x < 1) {
    return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  }
  return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x +
          (8 * b + 24 * c)) /
         6;
}

/// Calls add(t, weight) for nodes of Gauss and Legendre from `begin` to `end`, 5 in each part of at
/// most `longest`, which is short beside what is integrated.
template <class Add>
void visit_nodes(Real begin, Real end, Real longest, const Add& add) {
  constexpr Real places[] = {0, 0.538469310105683091L, 0.906179845938663993L};
  constexpr Real weights[] = {0.568888888888888889L, 0.478628670499366468L, 0.236926885056189088L};
  const int parts = 1 + static_cast<int>((end - begin) / longest);
  const Real half = (end - begin) / static_cast<Real>(2 * parts);
  for (int part = 0; part < parts; ++part) {
    const Real middle = begin + half * static_cast<Real>(2 * part + 1);
    for (int node = -2; node <= 2; ++node) {
      const Real offset = static_cast<Real>(node < 0 ? -1 : 1) * places[std::abs(node)];
      add(middle + half * offset, half * weights[std::abs(node)]);
    }
  }
}

/// Integral of the filter times cos(omega t + phase), between the places where it has a kink. Its
/// error is below 1e-14.
inline Real filter_integral(freqsynth::PixelFilter filter, const freqsynth::PixelFilterShape& shape,
                            Real begin, Real end, Real omega, Real phase) {
  const Real r = filter_radius(filter, shape);
  Real longest = std::min(0.4L / std::max(std::abs(omega), 1e-9L), r / 10);
  if (filter == freqsynth::PixelFilter::gaussian) {
    longest = std::min(longest, 0.4L * static_cast<Real>(shape.sigma));
  }
  Real sum = 0;
  for (int part = -2; part < 2; ++part) {
    const Real from = std::max(begin, static_cast<Real>(part) * r / 2);
    const Real to = std::min(end, static_cast<Real>(part + 1) * r / 2);
    if (from >= to) continue;
    visit_nodes(from, to, longest, [&](Real t, Real weight) {
      sum += weight * filter_value(filter, shape, t) * std::cos(omega * t + phase);
    });
  }
  return sum;
}

/// Pixels of a line whose averages are known, by the definition: the function is the derivative of
/// a natural cubic spline through the sums of the averages.
class Histospline {
 public:
  explicit Histospline(const std::vector<Real>& averages)
      : averages_(averages), second_(averages.size() + 1) {
    // M_{i-1} + 4 M_i + M_{i+1} = 6 (m_i - m_{i-1}), by so many rounds of Gauss and Seidel.
    for (int round = 0; round < 60; ++round) {
      for (std::size_t i = 1; i < averages.size(); ++i) {
        second_[i] = (6 * (averages[i] - averages[i - 1]) - second_[i - 1] - second_[i + 1]) / 4;
      }
    }
  }

  [[nodiscard]] Real at(std::size_t pixel, Real t) const {
    return averages_[pixel] + second_[pixel] * (1 - 3 * (1 - t) * (1 - t)) / 6 +
           second_[pixel + 1] * (3 * t * t - 1) / 6;
  }

  /// Filtered around the centre of pixel `p` of `out`.
  [[nodiscard]] Real filtered(std::size_t p, std::size_t out, freqsynth::PixelFilter filter,
                              const freqsynth::PixelFilterShape& shape) const {
    const Real scale = static_cast<Real>(out) / static_cast<Real>(averages_.size());
    const Real centre = (static_cast<Real>(p) + 0.5L) / scale;
    const Real r = filter_radius(filter, shape) / scale;
    Real sum = 0, weights = 0;
    for (std::size_t i = 0; i < averages_.size(); ++i) {
      for (int part = -2; part < 2; ++part) {
        const Real from = std::max(static_cast<Real>(i), centre + static_cast<Real>(part) * r / 2);
        const Real to =
            std::min(static_cast<Real>(i + 1), centre + static_cast<Real>(part + 1) * r / 2);
        if (from >= to) continue;
        visit_nodes(from, to, (to - from) / 4, [&](Real at, Real length) {
          const Real weight = length * filter_value(filter, shape, (at - centre) * scale);
          sum += weight * this->at(i, at - static_cast<Real>(i));
          weights += weight;
        });
      }
    }
    return sum / weights;
  }

 private:
  std::vector<Real> averages_, second_;
};

}  // namespace oracle
