/// \file
/// The `dof` scene.
#pragma once

#include "camera.h"
#include "scene.h"
#include "solid_world.h"

namespace scenes {

/// A row of balls on a checkered floor seen through a thin lens: the second is in focus, what is
/// nearer or farther blurs. Noisy: each sample looks through one random point of the lens.
class DepthOfField final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0; any seed.
  DepthOfField(int width, int height, std::uint64_t seed);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool noisy() const override { return true; }

 private:
  SolidWorld world_;
  Camera camera_;
  std::uint64_t seed_;
};

}  // namespace scenes
