// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/box_covariance.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/rounding.h"

namespace freqsynth::detail {

/// Newton's method for the zeros of Legendre's polynomial.
FREQSYNTH_ROUNDING inline Quadrature Quadrature::gauss(std::size_t count) {
  FREQSYNTH_ROUNDING_BEGIN
  Quadrature rule;
  rule.nodes.resize(count);
  rule.weights.resize(count);
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    double x = cos_turns((static_cast<double>(i) + 0.75) / (n + 0.5) * 0.5);
    double slope = 1;
    for (int step = 0; step < 8; ++step) {
      double before = 0, value = 1;
      for (std::size_t k = 1; k <= count; ++k) {
        const auto order = static_cast<double>(k);
        const double next = ((2 * order - 1) * x * value - (order - 1) * before) / order;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule.nodes[i] = 0.5 * (1 - x);
    rule.weights[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

/// Nodes along an axis for a function that changes over `change` of its length, and makes `turns`
/// waves.
inline std::size_t nodes_for(double change, double turns) {
  return static_cast<std::size_t>(std::min(40.0, 5 + std::ceil(3 * change + 3 * turns)));
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE BoxCovariance::BoxCovariance(const Covariance& covariance,
                                                                 const AverageGrid& grid)
    : function_(covariance), grid_(grid) {
  FREQSYNTH_ROUNDING_BEGIN
  require(grid.side >= 1 && grid.side <= 32, "side", static_cast<double>(grid.side), "in 1..32");
  require(grid.origin >= -4 && grid.origin <= 4, "origin", grid.origin, "in -4..4");
  require(grid.edge >= 0.001 && grid.edge <= 4, "edge", grid.edge, "in 0.001..4");
  by_edges_ = covariance.shape <= CovarianceShape::matern32;
  const UnitPoint u = function_.scaled({grid.edge, 0}), v = function_.scaled({0, grid.edge});
  scaled_area_ = u.s * v.t - u.t * v.s;
  const double reach = std::max(std::sqrt(u.s * u.s + u.t * u.t), std::sqrt(v.s * v.s + v.t * v.t));
  rule_ = Quadrature::gauss(nodes_for(reach, covariance.frequency * grid.edge));
  outer_ = by_edges_ ? Quadrature::gauss(16) : rule_;
  // Of exp(-q), or (1 + q) exp(-q): the coefficients of q^k, divided by k + 2.
  double factorial = 1;
  for (std::size_t k = 0; k < series_.size(); ++k) {
    const auto order = static_cast<double>(k);
    if (k > 0) factorial *= -order;
    const double factor = covariance.shape == CovarianceShape::exponential ? 1 : 1 - order;
    series_[k] = factor / (factorial * (order + 2));
  }
}

/// The integral of the covariance over the disc of radius q, by 2 pi q^2: times the vector to a
/// place it is a field whose divergence there is the covariance.
FREQSYNTH_ROUNDING inline double BoxCovariance::flux_density(double q) const {
  FREQSYNTH_ROUNDING_BEGIN
  if (q < 0.7) {
    double sum = 0;
    for (std::size_t k = series_.size(); k-- > 0;) sum = sum * q + series_[k];
    return sum;
  }
  const double square = q * q;
  const double left = exp_minus(q);
  if (function_.covariance().shape == CovarianceShape::exponential) {
    return (1 - (1 + q) * left) / square;
  }
  return (3 - (square + 3 * q + 3) * left) / square;
}

FREQSYNTH_ROUNDING inline double BoxCovariance::flux_of_part(UnitPoint from, UnitPoint step) const {
  FREQSYNTH_ROUNDING_BEGIN
  double sum = 0;
  for (std::size_t i = 0; i < rule_.nodes.size(); ++i) {
    const double x = from.s + rule_.nodes[i] * step.s, y = from.t + rule_.nodes[i] * step.t;
    sum += rule_.weights[i] * flux_density(std::sqrt(x * x + y * y));
  }
  return sum * (from.s * step.t - from.t * step.s);
}

/// Flux of that field through the line between two places, in scaled coordinates.
FREQSYNTH_ROUNDING inline double BoxCovariance::flux(UnitPoint from, UnitPoint to) const {
  FREQSYNTH_ROUNDING_BEGIN
  const UnitPoint step{to.s - from.s, to.t - from.t};
  // Where the line is nearest the function bends most.
  const double nearest = -(from.s * step.s + from.t * step.t) / (step.s * step.s + step.t * step.t);
  if (!(nearest > 0 && nearest < 1)) return flux_of_part(from, step);
  const UnitPoint part{nearest * step.s, nearest * step.t};
  const UnitPoint middle{from.s + part.s, from.t + part.t};
  return flux_of_part(from, part) + flux_of_part(middle, {to.s - middle.s, to.t - middle.t});
}

/// Covariance of the value at the origin with the average of the box whose corner is there.
FREQSYNTH_ROUNDING inline double BoxCovariance::with_box_at(UnitPoint corner) const {
  FREQSYNTH_ROUNDING_BEGIN
  if (by_edges_) {
    const double s = corner.s, t = corner.t, edge = grid_.edge;
    const UnitPoint a = function_.scaled(corner), b = function_.scaled({s + edge, t});
    const UnitPoint c = function_.scaled({s + edge, t + edge}), d = function_.scaled({s, t + edge});
    return (flux(a, b) + flux(b, c) + flux(c, d) + flux(d, a)) / scaled_area_;
  }
  double sum = 0;
  for (std::size_t j = 0; j < rule_.nodes.size(); ++j) {
    double row = 0;
    for (std::size_t i = 0; i < rule_.nodes.size(); ++i) {
      row += rule_.weights[i] * function_({corner.s + rule_.nodes[i] * grid_.edge,
                                           corner.t + rule_.nodes[j] * grid_.edge});
    }
    sum += rule_.weights[j] * row;
  }
  return sum;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE void BoxCovariance::with_point(UnitPoint point,
                                                                   std::span<double> out) const {
  FREQSYNTH_ROUNDING_BEGIN
  FREQSYNTH_ASSERT(out.size() == grid_.count());
  const std::size_t side = grid_.side;
  const auto place = [&](std::size_t x, std::size_t y) -> UnitPoint {
    return {grid_.origin + static_cast<double>(x) * grid_.edge - point.s,
            grid_.origin + static_cast<double>(y) * grid_.edge - point.t};
  };
  if (!by_edges_) {
    for (std::size_t y = 0; y < side; ++y) {
      for (std::size_t x = 0; x < side; ++x) out[y * side + x] = with_box_at(place(x, y));
    }
    return;
  }
  // An edge is one of two boxes.
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t y = 0; y <= side; ++y) {
    for (std::size_t x = 0; x <= side; ++x) {
      const UnitPoint corner = function_.scaled(place(x, y));
      if (x < side) {
        const double down = flux(corner, function_.scaled(place(x + 1, y)));
        if (y < side) out[y * side + x] += down;
        if (y > 0) out[(y - 1) * side + x] -= down;
      }
      if (y < side) {
        const double right = flux(corner, function_.scaled(place(x, y + 1)));
        if (x < side) out[y * side + x] -= right;
        if (x > 0) out[y * side + x - 1] += right;
      }
    }
  }
  for (double& value : out) value /= scaled_area_;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE double BoxCovariance::with_box(UnitPoint d) const {
  FREQSYNTH_ROUNDING_BEGIN
  double sum = 0;
  for (std::size_t j = 0; j < outer_.nodes.size(); ++j) {
    double row = 0;
    for (std::size_t i = 0; i < outer_.nodes.size(); ++i) {
      row += outer_.weights[i] *
             with_box_at({d.s - outer_.nodes[i] * grid_.edge, d.t - outer_.nodes[j] * grid_.edge});
    }
    sum += outer_.weights[j] * row;
  }
  return sum;
}

}  // namespace freqsynth::detail
