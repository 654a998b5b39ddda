// SPDX-License-Identifier: MIT
/// \file
/// Covariances of averages over square boxes, such as pixels, with the values at points.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/kernels.h"

namespace freqsynth {

/// Boxes side by side whose averages are asked for: side x side squares, row by row.
struct AverageGrid {
  std::size_t side = block_size;   ///< boxes in a row, 1 to 32
  double origin = 0;               ///< s and t of the upper left corner of the first, -4 to 4
  double edge = 1.0 / block_size;  ///< of each box, 0.001 to 4

  /// The node in side x side parts.
  static constexpr AverageGrid of_node(std::size_t side) {
    return {side, 0, 1 / static_cast<double>(side)};
  }
  /// The same, with `margin` more boxes of that size on each side.
  static constexpr AverageGrid with_margin(std::size_t side, std::size_t margin) {
    const double edge = 1 / static_cast<double>(side);
    return {side + 2 * margin, -edge * static_cast<double>(margin), edge};
  }
  /// Number of boxes.
  [[nodiscard]] constexpr std::size_t count() const { return side * side; }

  friend bool operator==(const AverageGrid&, const AverageGrid&) = default;
};

namespace detail {

/// Nodes of quadrature in 0..1 and their weights, whose sum is 1.
struct Quadrature {
  std::vector<double> nodes, weights;

  /// Gauss-Legendre with `count` nodes, 1 to 64: exact for polynomials below degree 2 count.
  static Quadrature gauss(std::size_t count);
};

/// Covariances of averages over the boxes of a grid. exponential and matern32 have a cusp where the
/// points meet, which quadrature over an area does not like: by the divergence theorem, their
/// integral over a box is one along its edges, of a function that has hardly any. All others
/// are products of quadratures; so they are exactly those of a weighted sum of values in the box,
/// and no variance comes out below zero.
///
/// The greatest error that was found is 6e-7 for the pixels of a block, and 3e-6 for a whole node,
/// with lengths of 0.35 to 20 and up to 6.25 waves.
class FREQSYNTH_API BoxCovariance {
 public:
  /// \throws std::invalid_argument naming the field and the value when one is out of range.
  BoxCovariance(const Covariance& covariance, const AverageGrid& grid);

  /// The covariance of points.
  [[nodiscard]] const CovarianceFunction& function() const { return function_; }
  /// The boxes.
  [[nodiscard]] const AverageGrid& grid() const { return grid_; }
  /// Covariance of the value at a point, without noise, with each of the averages.
  /// \param out  grid().count() values
  void with_point(UnitPoint point, std::span<double> out) const;
  /// Covariance of the averages of two boxes whose centres are `d` apart.
  [[nodiscard]] double with_box(UnitPoint d) const;

 private:
  /// What is evaluated together: lines, in scaled coordinates, or nodes within a box.
  struct Work;

  [[nodiscard]] double with_box_at(UnitPoint corner, Work& work) const;
  void add_line(UnitPoint from, UnitPoint to, Work& work) const;
  void add_part(UnitPoint from, UnitPoint step, Work& work) const;
  void find_fluxes(Work& work) const;

  CovarianceFunction function_;
  AverageGrid grid_;
  bool by_edges_ = false;
  double scaled_area_ = 0;                       // of a box, in scaled coordinates
  std::array<double, flux_series> series_ = {};  // of the flux density for small distances
  Quadrature rule_, outer_;
};

}  // namespace detail
}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/box_covariance.inl"
#endif
