// SPDX-License-Identifier: MIT
/// \file
/// A few solids on a floor, for the ray-traced scenes with random secondary rays.
#pragma once

#include <optional>
#include <vector>

#include "solids.h"
#include "vec3.h"

namespace scenes {

/// Diffuse solids on an endless checkered floor in the plane z = 0.
class SolidWorld {
 public:
  struct Part {
    Solid solid;
    Vec3 color;  ///< share of the light that it scatters, 0..1
  };
  struct Floor {
    Vec3 light, dark;  ///< colours of the tiles
    double tile;       ///< side of a tile
  };
  /// Where a ray has met something.
  struct Surface {
    double t;     ///< along the ray
    Vec3 point;   ///< lifted off the surface a little, so that a new ray can start here
    Vec3 normal;  ///< of unit length, outwards
    Vec3 color;   ///< share of the light that is scattered
    bool is_floor;
  };

  SolidWorld(const Floor& floor, std::vector<Part> parts);

  /// The first thing that a ray from outside of all solids meets.
  [[nodiscard]] std::optional<Surface> find(const Ray& ray) const;

  /// Whether a solid stands between the ray's origin and the point at `distance` along it.
  [[nodiscard]] bool is_hidden(const Ray& ray, double distance) const;

  /// What the ray sees by day: the sky, or scattered light of the sun, with hard shadows and a
  /// highlight on solids, and of the sky. The floor fades into the haze of the horizon.
  [[nodiscard]] Vec3 in_daylight(const Ray& ray) const;
  /// The same, where find() has already been called.
  [[nodiscard]] Vec3 in_daylight(const Ray& ray, const std::optional<Surface>& surface) const;

 private:
  Floor floor_;
  std::vector<Part> parts_;
};

}  // namespace scenes
