// SPDX-License-Identifier: MIT
/// \file
/// The `chess` scene: a small recursive ray tracer (Whitted 1980).
#pragma once

#include "../camera.h"
#include "../scene.h"
#include "../vec3.h"
#include "chess_set.h"
#include "material.h"

namespace scenes::chess {

/// A chess board with its 32 pieces on a tiled ground under the sky: hard shadows of two lamps,
/// mirror reflections in the lacquer of board and pieces, and highlights.
///
/// The lesser side of the image always sees the whole board. Radiances are mostly within 0..1, with
/// highlights above. A sample costs a few microseconds.
class ChessScene final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0.
  ChessScene(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;

 private:
  struct Surface;

  [[nodiscard]] bool find_surface(const Ray& ray, Surface& surface) const;
  [[nodiscard]] bool is_shadowed(const Surface& surface, const Vec3& to_lamp,
                                 double distance) const;
  /// The light that arrives along the ray from beyond its origin. `weight` is the share of it that
  /// reaches the eye, `bounces` the number of reflections left.
  [[nodiscard]] Vec3 trace(const Ray& ray, double weight, int bounces) const;
  [[nodiscard]] Vec3 lamp_light(const Ray& ray, const Surface& surface) const;

  ChessSet set_;
  Camera camera_;
};

}  // namespace scenes::chess
