// SPDX-License-Identifier: MIT
/// \file
/// Areas in closed form, for scenes whose pixel averages are known.
#pragma once

namespace scenes {

/// The area of the part of the unit square [0, 1]^2 where a x + b y < c. Neither |a| nor |b| may be
/// so small against the other that their product loses its digits: at least 1e-3 of it, say.
[[nodiscard]] double half_plane_area(double a, double b, double c);

/// The area of the part of the pixel with the corners (left, top) and (left + 1, top + 1) that lies
/// within `radius` of the origin; an absolute error of about 1e-16 radius^2.
[[nodiscard]] double disc_area(double left, double top, double radius);

/// The area of the part of the unit square [0, 1]^2 to the left of the line through (at_top, 0) and
/// (at_bottom, 1). Any line that is not horizontal; no digits are lost where it is nearly vertical.
[[nodiscard]] double left_area(double at_top, double at_bottom);

/// The area of the part of the same pixel as of disc_area() that lies in a sector of the disc: at
/// angles from `begin` to `end`, in turns from the x axis towards the y axis, begin < end < begin +
/// 1/2. The same error.
[[nodiscard]] double sector_area(double left, double top, double radius, double begin, double end);

}  // namespace scenes
