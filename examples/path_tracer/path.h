// SPDX-License-Identifier: MIT
/// \file
/// The light that comes along a ray, by one random path.
#pragma once

#include "decisions.h"
#include "world.h"

namespace path_tracer {

/// How paths are made. The mean over all random decisions does not depend on it.
struct PathSettings {
  /// Diffuse surfaces ask a point of a light directly, instead of meeting lights by chance.
  bool ask_lights = true;
};

/// What a path brings, and what it met first.
struct PathSample {
  Vec3 radiance{0, 0, 0};
  // Features of the first surface; all 0 where there is none.
  Vec3 colour{0, 0, 0};
  Vec3 normal{0, 0, 0};
  double nearness = 0;  ///< 1 / distance
};

/// Follows a path (Kajiya 1986). The mean of its radiance over all decisions is that of the ray,
/// but for paths of more than 64 surfaces.
[[nodiscard]] PathSample trace(const World& world, const Ray& ray, double time,
                               const Decisions& decisions, const PathSettings& settings = {});

}  // namespace path_tracer
