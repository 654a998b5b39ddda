// SPDX-License-Identifier: MIT
/// \file
/// Scenes by name, and samples of them, for the tests of the scenes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace scene_helpers {

using Color = std::array<float, 3>;

inline Color radiance(const scenes::Scene& scene, double x, double y, std::uint64_t id = 0) {
  Color rgb{};
  scene.radiance(x, y, id, rgb);
  return rgb;
}

inline std::unique_ptr<scenes::Scene> make(std::string_view name, int width, int height,
                                           std::uint64_t seed = 0) {
  return scenes::make_scene(
      {.name = std::string(name), .width = width, .height = height, .seed = seed});
}

inline const std::set<std::string_view> noisy_names{"softshadow", "dof", "glossy", "cornell",
                                                    "spheres"};

/// Positions and ids of samples.
struct Samples {
  std::vector<double> x, y;
  std::vector<std::uint64_t> id;

  Samples(std::size_t count, int width, int height) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> across(0, width), down(0, height);
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(across(random));
      y.push_back(down(random));
      id.push_back(random());
    }
  }
};

}  // namespace scene_helpers
