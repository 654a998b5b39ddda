// SPDX-License-Identifier: MIT
/// \file
/// What the pieces stand on: the board, and the ground under it.
#pragma once

#include <optional>

#include "../vec3.h"
#include "material.h"

namespace scenes::chess {

/// A slab with chamfered edges. Its top is the plane z = 0, with squares of side 1 around the
/// origin and a frame around them.
struct Board {
  static constexpr double kThickness = 0.42;

  [[nodiscard]] static std::optional<Hit> intersect(const Ray& ray, double t0, double t1);
  [[nodiscard]] static Material material(const Vec3& p);
};

/// The plane z = -Board::kThickness, tiled to the horizon.
struct Ground {
  [[nodiscard]] static std::optional<Hit> intersect(const Ray& ray, double t0, double t1);
  [[nodiscard]] static Material material(const Vec3& p);
  /// How much of the sky the board leaves to a point of the ground, 0..1.
  [[nodiscard]] static double openness(const Vec3& p);
};

}  // namespace scenes::chess
