// SPDX-License-Identifier: MIT
/// \file
/// The `sun` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// A low sun of radiance 1000 (the sky around it has about 1, the hills 0.01) behind hills with
/// firs, one of which cuts into its disc: high dynamic range at hard edges.
class Sun final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0.
  Sun(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;

 private:
  double unit_;  // per pixel; the lesser side of the image is 1
  double middle_;
};

}  // namespace scenes
