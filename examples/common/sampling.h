// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "scenes/scene.h"

/// The scene's value at (x, y) in pixels: 3 channels, or 1 for its luminance (Rec. 709). `id` names
/// the sample.
inline void sample_scene(const scenes::Scene& scene, double x, double y, std::uint64_t id,
                         std::span<float> value) {
  std::array<float, 3> rgb{};
  scene.radiance(x, y, id, rgb);
  if (value.size() == 1) {
    value[0] = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
  } else {
    std::copy(rgb.begin(), rgb.end(), value.begin());
  }
}
