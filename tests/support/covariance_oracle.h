// SPDX-License-Identifier: MIT
/// \file
/// Slow, obviously right computations with covariances and Gaussian processes, in long double.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/box_covariance.h"
#include "freqsynth/basis/covariance.h"
#include "support/oracles.h"

namespace oracle {

inline double radians(double degrees) { return static_cast<double>(degrees * pi / 180); }

/// One of each kind, with lengths and noise as the library uses them.
inline std::vector<freqsynth::Covariance> covariances() {
  using freqsynth::Covariance;
  using Shape = freqsynth::CovarianceShape;
  return {Covariance::isotropic(Shape::exponential, 0.7, 0.003),
          Covariance::oriented(Shape::exponential, 20, 1, radians(30), 0.003),
          Covariance::isotropic(Shape::exponential, 4, 10),
          Covariance::isotropic(Shape::matern32, 0.35, 0.001),
          Covariance::oriented(Shape::matern32, 8, 0.4, radians(100), 0.001),
          Covariance::isotropic(Shape::matern52, 0.4, 0.001),
          Covariance::isotropic(Shape::matern52, 6, 1e-8),
          Covariance::isotropic(Shape::squared_exponential, 0.5, 1e-4),
          Covariance::oscillating(Shape::matern52, 1.2, 6.25, radians(70), 0.001)};
}

inline std::string name(const freqsynth::Covariance& covariance) {
  return "shape " + std::to_string(static_cast<int>(covariance.shape)) + ", lengths " +
         std::to_string(covariance.along) + " and " + std::to_string(covariance.across) +
         ", frequency " + std::to_string(covariance.frequency);
}

/// The formulas of CovarianceShape.
inline Real covariance(const freqsynth::Covariance& covariance, Real ds, Real dt) {
  const Real c = std::cos(Real{covariance.angle}), s = std::sin(Real{covariance.angle});
  const Real along = c * ds + s * dt, across = c * dt - s * ds;
  const Real r = std::hypot(along / covariance.along, across / covariance.across);
  const Real wave = std::cos(2 * pi * covariance.frequency * across);
  switch (covariance.shape) {
    case freqsynth::CovarianceShape::exponential:
      return std::exp(-r);
    case freqsynth::CovarianceShape::matern32: {
      const Real q = std::sqrt(Real{3}) * r;
      return (1 + q) * std::exp(-q);
    }
    case freqsynth::CovarianceShape::matern52: {
      const Real q = std::sqrt(Real{5}) * r;
      return (1 + q + q * q / 3) * std::exp(-q) * wave;
    }
    default:
      return std::exp(-r * r / 2) * wave;
  }
}

/// Places and weights of Gauss rules with 5 nodes on `parts` equal parts of an interval.
inline std::vector<std::pair<Real, Real>> composite_rule(Real low, Real high, int parts) {
  const Real at[] = {0, std::sqrt(5 - 2 * std::sqrt(Real{10} / 7)) / 3,
                     std::sqrt(5 + 2 * std::sqrt(Real{10} / 7)) / 3};
  const Real weight[] = {Real{128} / 225, (322 + 13 * std::sqrt(Real{70})) / 900,
                         (322 - 13 * std::sqrt(Real{70})) / 900};
  std::vector<std::pair<Real, Real>> rule;
  const Real half = (high - low) / (2 * parts);
  for (int i = 0; i < parts; ++i) {
    const Real middle = low + (2 * i + 1) * half;
    rule.emplace_back(middle, half * weight[0]);
    for (int k = 1; k < 3; ++k) {
      rule.emplace_back(middle + half * at[k], half * weight[k]);
      rule.emplace_back(middle - half * at[k], half * weight[k]);
    }
  }
  return rule;
}

/// Integral over the square from (left, top) of a function that may have a cusp at the origin and a
/// ridge through it, along `angle`: in polar coordinates, between the angles of the corners, of the
/// axes and of the ridge.
template <class Function>
Real polar_integral(Real left, Real top, Real edge, Real angle, Function function) {
  std::vector<Real> angles;
  for (const Real s : {left, left + edge}) {
    for (const Real t : {top, top + edge}) angles.push_back(std::atan2(t, s));
  }
  // Finer towards the ridge, and towards the axes, along which an edge may run that is very near.
  for (const Real centre :
       {angle, angle + pi, angle - pi, angle - 2 * pi, -pi, -pi / 2, Real{0}, pi / 2, pi}) {
    if (std::abs(centre) > pi) continue;
    angles.push_back(centre);
    for (Real off = 0.4L; off > 0.001L; off /= 2) {
      angles.push_back(std::min(pi, centre + off));
      angles.push_back(std::max(-pi, centre - off));
    }
  }
  std::sort(angles.begin(), angles.end());
  const auto span = [](Real low, Real high, Real direction) -> std::pair<Real, Real> {
    const Real a = low / direction, b = high / direction;
    return {std::min(a, b), std::max(a, b)};
  };
  Real sum = 0;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    if (angles[i + 1] - angles[i] < 1e-12L) continue;
    for (const auto& [at, turn] : composite_rule(angles[i], angles[i + 1], 3)) {
      const Real c = std::cos(at), s = std::sin(at);
      const auto [s0, s1] = span(left, left + edge, c);
      const auto [t0, t1] = span(top, top + edge, s);
      const Real first = std::max({s0, t0, Real{0}}), last = std::min(s1, t1);
      if (!(last > first)) continue;
      const int parts = 1 + static_cast<int>(20 * (last - first));
      for (const auto& [r, step] : composite_rule(first, last, parts)) {
        sum += turn * step * r * function(r * c, r * s);
      }
    }
  }
  return sum;
}

/// Covariance of the value at a point with the average over a box of a grid.
inline Real covariance_with_box(const freqsynth::Covariance& kernel, freqsynth::UnitPoint point,
                                const freqsynth::AverageGrid& grid, std::size_t box) {
  const Real edge = grid.edge;
  const Real left = grid.origin + edge * static_cast<Real>(box % grid.side) - point.s;
  const Real top = grid.origin + edge * static_cast<Real>(box / grid.side) - point.t;
  return polar_integral(left, top, edge, kernel.angle,
                        [&](Real s, Real t) { return covariance(kernel, s, t); }) /
         (edge * edge);
}

/// Covariance of the averages over two boxes whose centres are `d` apart: over all differences of
/// their points, which are distributed like a pyramid.
inline Real covariance_of_boxes(const freqsynth::Covariance& kernel, freqsynth::UnitPoint d,
                                Real edge) {
  Real sum = 0;
  for (const Real left : {d.s - edge, Real{d.s}}) {
    for (const Real top : {d.t - edge, Real{d.t}}) {
      sum += polar_integral(left, top, edge, kernel.angle, [&](Real s, Real t) {
        return (1 - std::abs(s - d.s) / edge) * (1 - std::abs(t - d.t) / edge) *
               covariance(kernel, s, t);
      });
    }
  }
  return sum / (edge * edge);
}

}  // namespace oracle
