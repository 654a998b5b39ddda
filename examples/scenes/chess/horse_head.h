// SPDX-License-Identifier: MIT
/// \file
/// The carved part of the knight.
#pragma once

#include <optional>

#include "../vec3.h"

namespace scenes::chess {

/// No part of the horse's head is higher than this, or farther from the z axis.
inline constexpr double kHorseHeadTop = 1.14;
inline constexpr double kHorseHeadReach = 0.345;

/// Where a ray first meets, within `range`, a horse's neck and head that looks along x and is
/// symmetric about the plane y = 0. A ray that starts inside meets it at once.
///
/// The head is a smooth union of tapered capsules, given by a function that never exceeds the
/// distance to the surface, so that a ray can safely advance by its value (sphere tracing, Hart
/// 1996).
[[nodiscard]] std::optional<Hit> intersect_horse_head(const Ray& ray, Interval range);

}  // namespace scenes::chess
