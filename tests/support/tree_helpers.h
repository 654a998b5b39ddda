// SPDX-License-Identifier: MIT
/// \file
/// A scene for trees of nodes, and what tests look at.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/engine/tree_sampler.h"

namespace freqsynth::tree_helpers {

using Rgb = std::array<float, 3>;
/// Edges, a texture in a corner, and a bright spot.
inline Rgb scene(double x, double y) {
  const double edge = x + 0.3 * y > 31.7 ? 1 : 0;
  const double texture = x < 15 && y < 15 ? std::sin(5 * x) * std::sin(7 * y) : 0;
  const double spot = std::hypot(x - 40, y - 20) < 0.6 ? 30 : 0;
  return {static_cast<float>(edge + texture), static_cast<float>(spot),
          static_cast<float>(0.01 * x)};
}

inline TreeSettings settings_of(std::size_t width, std::size_t height) {
  TreeSettings settings;
  settings.width = width;
  settings.height = height;
  settings.seed = 4;
  settings.wave = 16;
  return settings;
}

/// The numbers of all leaves and their samples.
inline std::vector<std::uint32_t> shape(const TreeSampler& sampler) {
  std::vector<std::uint32_t> shape;
  for (std::uint32_t i = 0; i < sampler.tree().size(); ++i) {
    const TreeNode& node = sampler.tree().node(i);
    shape.insert(shape.end(), {node.block, node.depth, node.samples, node.quadrants});
  }
  return shape;
}

}  // namespace freqsynth::tree_helpers
