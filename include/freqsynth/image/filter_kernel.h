// SPDX-License-Identifier: MIT
/// \file
/// A pixel filter along one axis, and its exact integrals times a cosine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/pixel_filter.h"

namespace freqsynth::detail {

/// A filter along one axis.
class FilterKernel {
 public:
  /// \param shape  valid for the filter, which is not `none`
  FilterKernel(PixelFilter filter, const PixelFilterShape& shape);

  [[nodiscard]] double radius() const { return radius_; }
  /// Whether some weights are below zero.
  [[nodiscard]] bool has_negative() const { return filter_ == PixelFilter::mitchell; }

  /// Adds the integral from t = begin to t = end of the filter times cos(u (omega t + phase)) to
  /// sums[u]. In closed form, but for `gaussian`, where Gauss-Legendre quadrature leaves out less
  /// than 1e-13 of the filter's own integral.
  void integrate(double begin, double end, double omega, double phase,
                 std::span<double, block_size> sums) const;

  /// Calls add(t, weight) for the nodes of a quadrature from t = begin to t = end, whose weights
  /// have the filter in them. Leaves out less than 1e-13 of the filter's own integral for cosines
  /// up to cos(fastest t) and for polynomials of degree 2.
  template <class Add>
  void visit_nodes(double begin, double end, double fastest, const Add& add) const;

 private:
  void add_pieces(double begin, double end, double omega, double phase,
                  std::span<double, block_size> sums) const;
  void add_cosines(double begin, double end, double omega, double phase,
                   std::span<double, block_size> sums) const;
  [[nodiscard]] double value(double t) const;

  /// Polynomial of |t| / radius_ from the end of the piece before it to its own.
  struct Piece {
    double end = 0;
    double coefficients[4] = {};
  };

  PixelFilter filter_;
  double radius_, sigma_;
  Piece pieces_[2];
};

// ------------------------------------------------------------------------------------ definitions

template <class Add>
void FilterKernel::visit_nodes(double begin, double end, double fastest, const Add& add) const {
  // Gauss-Legendre of 8 nodes, in parts between kinks that are no longer than sigma, a quarter of
  // the radius and 2 radians: its relative error is that of the 16th derivative.
  constexpr double places[] = {0.18343464249564980494, 0.52553240991632898582,
                               0.79666647741362673959, 0.96028985649753623168};
  constexpr double weights[] = {0.36268378337836198297, 0.31370664587788728734,
                                0.22238103445337447054, 0.10122853629037625915};
  double finest = std::max(4 / radius_, fastest / 2);
  if (filter_ == PixelFilter::gaussian) finest = std::max(finest, 1 / sigma_);
  for (int piece = -2; piece < 2; ++piece) {
    const double low = std::max(begin, 0.5 * radius_ * piece);
    const double high = std::min(end, 0.5 * radius_ * (piece + 1));
    if (low >= high) continue;
    const double parts = std::ceil((high - low) * finest);
    const double half = 0.5 * (high - low) / parts;
    for (double part = 0; part < parts; ++part) {
      const double middle = low + (2 * part + 1) * half;
      for (int node = -4; node <= 4; ++node) {
        if (node == 0) continue;
        const int place = std::abs(node) - 1;
        const double t = middle + half * (node < 0 ? -places[place] : places[place]);
        add(t, value(t) * half * weights[place]);
      }
    }
  }
}

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/filter_kernel.inl"
#endif
