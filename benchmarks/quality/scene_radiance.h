// SPDX-License-Identifier: MIT
/// \file
/// The one place that knows the interface of the scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "baselines/rendering.h"
#include "baselines/sampler.h"
#include "freqsynth/sampler.h"
#include "quality/reference.h"
#include "scenes/scene.h"

namespace quality {

/// The scene as the methods see it. The scene must outlive the result.
inline baselines::Radiance radiance_of(const scenes::Scene& scene) {
  return [&scene](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    scene.radiance(x, y, id, rgb);
  };
}

/// The same with its features; empty where it has none. The scene must outlive the result.
inline baselines::FeaturedRadiance featured_radiance_of(const scenes::Scene& scene) {
  if (scene.features() == 0) return {};
  return [&scene](double x, double y, std::uint64_t id, std::span<float> values) {
    scene.radiance_and_features(x, y, id, values);
  };
}

/// What a method is told of a scene. The scene must outlive the result.
inline baselines::Job job_of(const scenes::Scene& scene, std::size_t width, std::size_t height,
                             std::uint64_t samples, std::uint64_t seed) {
  return {
      width, height, samples, seed, scene.noisy(), scene.features(), featured_radiance_of(scene)};
}

/// The id that a scene or a Radiance has for a sample that freqsynth asks for. Other seeds get
/// other noise.
inline std::uint64_t id_of(const freqsynth::Request& request, std::uint64_t seed) {
  return scenes::sample_id(request.pixel + baselines::scatter(seed), request.ordinal);
}

/// The pixels whose average the scene knows. The scene must outlive the result.
inline PixelAverage pixel_average_of(const scenes::Scene& scene) {
  return [&scene](std::size_t x, std::size_t y, std::span<float, 3> rgb) {
    return scene.pixel_average(static_cast<long>(x), static_cast<long>(y), rgb);
  };
}

}  // namespace quality
