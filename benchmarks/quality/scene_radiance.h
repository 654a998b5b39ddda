/// \file
/// The one place that knows the interface of the scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "baselines/rendering.h"
#include "quality/reference.h"
#include "scenes/scene.h"

namespace quality {

/// The scene as the methods see it. The scene must outlive the result.
inline baselines::Radiance radiance_of(const scenes::Scene& scene) {
  return [&scene](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
    scene.radiance(x, y, rgb);
  };
}

/// The exact pixels of the scene; empty when it knows none. The scene must outlive the result.
inline PixelAverage pixel_average_of(const scenes::Scene&) { return nullptr; }

}  // namespace quality
