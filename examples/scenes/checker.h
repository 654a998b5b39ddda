// SPDX-License-Identifier: MIT
/// \file
/// The `checker` scene.
#pragma once

#include "camera.h"
#include "scene.h"

namespace scenes {

/// A checkered floor in perspective, up to the horizon, under a plain sky. Squares that fill many
/// pixels near by become as small as one likes far away, first in height and then in width, so that
/// the far end shows all aliasing that a sampler lets through.
class Checker final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0.
  Checker(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;

 private:
  Camera camera_;
};

}  // namespace scenes
