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
#include "freqsynth/basis/kernels.h"
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

struct BoxCovariance::Work {
  std::vector<double> distances;     // from the origin, at the nodes of each part
  std::vector<double> densities;     // there, see FluxDensities
  std::vector<double> areas;         // of each part: twice that of its triangle with the origin
  std::vector<bool> last;            // of each part, whether it is the last one of its line
  std::vector<double> fluxes;        // of each line
  std::vector<double> s, t, values;  // at nodes within a box

  void clear() {
    distances.clear();
    areas.clear();
    last.clear();
    fluxes.clear();
  }
};

FREQSYNTH_ROUNDING inline void BoxCovariance::add_part(UnitPoint from, UnitPoint step,
                                                       Work& work) const {
  FREQSYNTH_ROUNDING_BEGIN
  for (const double node : rule_.nodes) {
    const double x = from.s + node * step.s, y = from.t + node * step.t;
    work.distances.push_back(std::sqrt(x * x + y * y));
  }
  work.areas.push_back(from.s * step.t - from.t * step.s);
  work.last.push_back(true);
}

/// One more line between two places.
FREQSYNTH_ROUNDING inline void BoxCovariance::add_line(UnitPoint from, UnitPoint to,
                                                       Work& work) const {
  FREQSYNTH_ROUNDING_BEGIN
  const UnitPoint step{to.s - from.s, to.t - from.t};
  // Where the line is nearest the function bends most.
  const double nearest = -(from.s * step.s + from.t * step.t) / (step.s * step.s + step.t * step.t);
  if (!(nearest > 0 && nearest < 1)) {
    add_part(from, step, work);
    return;
  }
  const UnitPoint part{nearest * step.s, nearest * step.t};
  const UnitPoint middle{from.s + part.s, from.t + part.t};
  add_part(from, part, work);
  work.last.back() = false;
  add_part(middle, {to.s - middle.s, to.t - middle.t}, work);
}

/// Through each line the flux of a field whose divergence is the covariance: the vector from the
/// origin to a place, times the flux density there.
FREQSYNTH_ROUNDING inline void BoxCovariance::find_fluxes(Work& work) const {
  FREQSYNTH_ROUNDING_BEGIN
  work.densities.resize(work.distances.size());
  const bool rough = function_.covariance().shape == CovarianceShape::exponential;
  flux_densities(work.distances.data(), work.distances.size(), series_.data(), rough,
                 work.densities.data());
  const double* density = work.densities.data();
  double flux = 0;
  for (std::size_t part = 0; part < work.areas.size(); ++part) {
    double sum = 0;
    for (const double weight : rule_.weights) sum += weight * *density++;
    flux += sum * work.areas[part];
    if (!work.last[part]) continue;
    work.fluxes.push_back(flux);
    flux = 0;
  }
}

/// Covariance of the value at the origin with the average of the box whose corner is there.
FREQSYNTH_ROUNDING inline double BoxCovariance::with_box_at(UnitPoint corner, Work& work) const {
  FREQSYNTH_ROUNDING_BEGIN
  if (by_edges_) {
    const double s = corner.s, t = corner.t, edge = grid_.edge;
    const UnitPoint a = function_.scaled(corner), b = function_.scaled({s + edge, t});
    const UnitPoint c = function_.scaled({s + edge, t + edge}), d = function_.scaled({s, t + edge});
    work.clear();
    add_line(a, b, work);
    add_line(b, c, work);
    add_line(c, d, work);
    add_line(d, a, work);
    find_fluxes(work);
    const double* const flux = work.fluxes.data();
    return (flux[0] + flux[1] + flux[2] + flux[3]) / scaled_area_;
  }
  const std::size_t nodes = rule_.nodes.size(), all = nodes * nodes;
  work.s.resize(all);
  work.t.resize(all);
  work.values.resize(all);
  for (std::size_t j = 0; j < nodes; ++j) {
    for (std::size_t i = 0; i < nodes; ++i) {
      work.s[j * nodes + i] = corner.s + rule_.nodes[i] * grid_.edge;
      work.t[j * nodes + i] = corner.t + rule_.nodes[j] * grid_.edge;
    }
  }
  function_.values(work.s.data(), work.t.data(), all, work.values.data());
  double sum = 0;
  for (std::size_t j = 0; j < nodes; ++j) {
    double row = 0;
    for (std::size_t i = 0; i < nodes; ++i) row += rule_.weights[i] * work.values[j * nodes + i];
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
  Work work;
  if (!by_edges_) {
    for (std::size_t y = 0; y < side; ++y) {
      for (std::size_t x = 0; x < side; ++x) out[y * side + x] = with_box_at(place(x, y), work);
    }
    return;
  }
  // An edge is one of two boxes.
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t y = 0; y <= side; ++y) {
    work.clear();
    for (std::size_t x = 0; x <= side; ++x) {
      const UnitPoint corner = function_.scaled(place(x, y));
      if (x < side) add_line(corner, function_.scaled(place(x + 1, y)), work);
      if (y < side) add_line(corner, function_.scaled(place(x, y + 1)), work);
    }
    find_fluxes(work);
    const double* flux = work.fluxes.data();
    for (std::size_t x = 0; x <= side; ++x) {
      if (x < side) {
        const double down = *flux++;
        if (y < side) out[y * side + x] += down;
        if (y > 0) out[(y - 1) * side + x] -= down;
      }
      if (y < side) {
        const double right = *flux++;
        if (x < side) out[y * side + x] -= right;
        if (x > 0) out[y * side + x - 1] += right;
      }
    }
  }
  for (double& value : out) value /= scaled_area_;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE double BoxCovariance::with_box(UnitPoint d) const {
  FREQSYNTH_ROUNDING_BEGIN
  Work work;
  double sum = 0;
  for (std::size_t j = 0; j < outer_.nodes.size(); ++j) {
    double row = 0;
    for (std::size_t i = 0; i < outer_.nodes.size(); ++i) {
      const UnitPoint corner{d.s - outer_.nodes[i] * grid_.edge,
                             d.t - outer_.nodes[j] * grid_.edge};
      row += outer_.weights[i] * with_box_at(corner, work);
    }
    sum += outer_.weights[j] * row;
  }
  return sum;
}

}  // namespace freqsynth::detail
