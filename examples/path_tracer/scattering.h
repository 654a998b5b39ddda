// SPDX-License-Identifier: MIT
/// \file
/// Where light goes that meets a surface.
#pragma once

#include <array>

#include "shapes.h"

namespace path_tracer {

/// Refractive index of glass.
inline constexpr double glass_index = 1.5;

/// Share of unpolarised light that is mirrored where a ray passes from one refractive index to
/// another (Fresnel); 1 where all of it is.
/// \param cosine  of the angle to the normal, in 0..1
/// \param ratio   index on the ray's side over that on the other
[[nodiscard]] double mirrored_share(double cosine, double ratio);

/// A direction about the unit vector `normal`, with a density of cosine / pi.
[[nodiscard]] Vec3 diffuse_direction(const Vec3& normal, const std::array<double, 2>& chance);

/// The direction that a mirror turns a ray to. `normal` to either side.
[[nodiscard]] Vec3 mirrored(const Vec3& direction, const Vec3& normal);

/// The direction in which a ray leaves a surface of glass: mirrored with the probability of
/// mirrored_share(), else refracted. Radiance along it counts as it is: what it loses where it
/// leaves the glass it has won where it came in.
/// \param normal  out of the glass
/// \param chance  in [0, 1)
[[nodiscard]] Vec3 glass_direction(const Vec3& direction, const Vec3& normal, double chance);

}  // namespace path_tracer
