// SPDX-License-Identifier: MIT
/// \file
/// The two scenes, and the camera that looks at them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "path.h"
#include "scenes/camera.h"
#include "world.h"

namespace path_tracer {

/// A world before a camera with a thin lens, whose shutter is open from time 0 to 1.
struct Scene {
  World world;
  scenes::Camera camera;
  double lens_radius = 0;
  double focus = 1;  ///< distance of the plane in focus from the lens

  /// What one path brings through (x, y), in pixels.
  [[nodiscard]] PathSample sample(double x, double y, const Decisions& decisions,
                                  const PathSettings& settings = {}) const;
  /// A ray through (x, y) and a random point of the lens.
  [[nodiscard]] Ray ray(double x, double y, const std::array<double, 2>& chance) const;
};

/// The names of the scenes:
/// * `cornell`  a box with a ball of glass, a block, and a small lamp
/// * `spheres`  a field of balls, some on their way, before a wide lens
inline constexpr std::array<std::string_view, 2> scene_names = {"cornell", "spheres"};

/// A scene for a picture of that size. \throws std::invalid_argument for an unknown name.
[[nodiscard]] Scene make_scene(std::string_view name, std::size_t width, std::size_t height);

}  // namespace path_tracer
