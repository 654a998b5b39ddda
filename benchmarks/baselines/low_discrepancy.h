// SPDX-License-Identifier: MIT
/// \file
/// Evenly spread points instead of jittered ones: the same pattern in each pixel, and scrambled
/// Sobol points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rendering.h"

namespace baselines {

using UnitPoint = std::array<double, 2>;  ///< x and y in (0, 1)

/// The g for which the lattice of the points (k / count, g k / count mod 1) has the greatest least
/// distance, where the unit square, which repeats, stands for one of this width and height. The
/// least such g without a common factor with `count`, so that no two points share a row or column.
[[nodiscard]] std::uint64_t lattice_generator(std::uint64_t count, double width = 1,
                                              double height = 1);

/// The pattern of rotated_grid(): the lattice of lattice_generator(), moved by half a step. Four
/// points of a lattice are all on one diagonal; there it is the pattern of graphics hardware, in
/// which no three are on a line.
[[nodiscard]] std::vector<UnitPoint> rotated_grid_points(std::uint64_t count);

/// A rank-1 lattice that is the same in each pixel, and the mean of the pixel. A number of samples
/// per pixel that is not whole gives one lattice over the image and a box that is widened by
/// width_for_rate(). Takes exactly the samples allowed; the seed moves none.
[[nodiscard]] Rendering rotated_grid(const Radiance& radiance, const Job& job);

/// Sobol points with a scramble of their own in each pixel, and the mean of the pixel. A number of
/// samples per pixel that is not whole gives one sequence over the image and a box that is widened
/// by width_for_rate(). Takes exactly the samples allowed, of which 2^32 at most may be in a pixel,
/// or in the image where the number is not whole.
[[nodiscard]] Rendering sobol_box(const Radiance& radiance, const Job& job);

}  // namespace baselines
