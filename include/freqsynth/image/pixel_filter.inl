// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/image/pixel_filter.h"

namespace freqsynth {
namespace detail {

inline double default_filter_radius(PixelFilter filter) {
  switch (filter) {
    case PixelFilter::none:
      return 0;
    case PixelFilter::box:
      return 0.5;
    case PixelFilter::tent:
      return 1;
    case PixelFilter::gaussian:
    case PixelFilter::blackman_harris:
      return 1.5;
    case PixelFilter::mitchell:
      return 2;
  }
  refuse("pixel_filter is " + std::to_string(static_cast<int>(filter)) +
         ", not none, box, tent, gaussian, blackman_harris or mitchell");
}

FREQSYNTH_INLINE double filter_radius(PixelFilter filter, const PixelFilterShape& shape) {
  const double usual = default_filter_radius(filter);
  return shape.radius > 0 ? shape.radius : usual;
}

}  // namespace detail

FREQSYNTH_INLINE void PixelFilterShape::validate(PixelFilter filter) const {
  static_cast<void>(detail::filter_radius(filter, *this));  // refuses what is no filter
  detail::require(detail::is_finite(radius) && radius >= 0 && radius <= 32, "filter_shape.radius",
                  radius, "0 or over 0 and at most 32");
  detail::require(detail::is_finite(sigma) && sigma >= 0.05 && sigma <= 1000, "filter_shape.sigma",
                  sigma, "in 0.05..1000");
  detail::require(detail::is_finite(b) && b >= 0 && b <= 1, "filter_shape.b", b, "in 0..1");
  detail::require(detail::is_finite(c) && c >= 0 && c <= 1, "filter_shape.c", c, "in 0..1");
}

}  // namespace freqsynth
