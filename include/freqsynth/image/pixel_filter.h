// SPDX-License-Identifier: MIT
/// \file
/// What a pixel's value is: the filters that renderers have.
#pragma once

#include <cstdint>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// What a pixel's value is: the function at its centre, or a weighted mean of it around there. All
/// weights are products of one of either axis. t is the distance from the pixel's centre along an
/// axis, r the radius, both in pixels of the output; beyond r weights are 0. A mean is over what
/// lies inside the image: weights are divided by their own integral there, as a renderer divides by
/// the sum of its samples' weights.
///
/// A function that was fit (CoefficientMeaning::point_function) is weighted as it is. Finished
/// pixels tell only averages of the function; except for `none`, and `box` of its own radius, it is
/// taken for the smoothest one that has them, the spline of degree 2 whose sum over pixels is a
/// natural cubic one; and where no weight is negative (all but `mitchell`) pixels stay within the
/// range of the finished pixels that the filter, but at least a pixel to each side, reaches.
enum class PixelFilter : std::uint8_t {
  none,             ///< the function's value at the pixel's centre
  box,              ///< all the same; r = 0.5: the exact average over the pixel's area
  tent,             ///< 1 - t / r; r = 1 (also called triangle)
  gaussian,         ///< exp(-t^2 / (2 sigma^2)) less its value at r; r = 1.5 and sigma = 0.5
  blackman_harris,  ///< 0.35875 + 0.48829 cos(p) + 0.14128 cos(2 p) + 0.01168 cos(3 p) with
                    ///< p = pi t / r; r = 1.5
  mitchell          ///< cubic of Mitchell and Netravali in 2 t / r; r = 2, B = C = 1/3. Partly
                    ///< negative: it sharpens, and pixels may overshoot
};

/// The numbers of a filter. `{}`: those that renderers have by default, as PixelFilter says.
struct PixelFilterShape {
  /// r in pixels of the output, half of what some renderers call a filter's width: over 0 and at
  /// most 32. 0: the filter's own.
  double radius = 0;
  /// Of PixelFilter::gaussian: its deviation in pixels of the output, in 0.05..1000.
  double sigma = 0.5;
  double b = 1.0 / 3;  ///< of PixelFilter::mitchell, in 0..1
  double c = 1.0 / 3;  ///< of PixelFilter::mitchell, in 0..1

  /// \throws std::invalid_argument naming the field and the value when out of range, also of
  ///         numbers that the filter does not have, and when `filter` is none of PixelFilter.
  FREQSYNTH_API void validate(PixelFilter filter) const;
};

namespace detail {

/// That of the shape, or the filter's own.
/// \throws std::invalid_argument when `filter` is none of PixelFilter.
[[nodiscard]] double filter_radius(PixelFilter filter, const PixelFilterShape& shape);

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/pixel_filter.inl"
#endif
