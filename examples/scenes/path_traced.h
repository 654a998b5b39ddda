// SPDX-License-Identifier: MIT
/// \file
/// The scenes of the path tracer: `cornell` and `spheres`.
#pragma once

#include <string_view>

#include "path_tracer/scene.h"
#include "scene.h"

namespace scenes {

/// A scene of examples/path_tracer; each sample follows one path. Noisy, with a few values that are
/// hundreds of times as bright as the others, where a path finds a lamp through glass.
class PathTraced final : public Scene {
 public:
  /// \param name  one of path_tracer::scene_names
  /// `width` and `height` in pixels, both > 0; any seed.
  PathTraced(std::string_view name, int width, int height, std::uint64_t seed);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool noisy() const override { return true; }
  [[nodiscard]] std::size_t features() const override { return feature_count; }
  void radiance_and_features(double x, double y, std::uint64_t id,
                             std::span<float> values) const override;

 private:
  [[nodiscard]] path_tracer::PathSample sample(double x, double y, std::uint64_t id) const;

  path_tracer::Scene scene_;
  std::uint64_t seed_;
};

}  // namespace scenes
