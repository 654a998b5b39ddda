// SPDX-License-Identifier: MIT
/// \file
/// The `softshadow` scene.
#pragma once

#include "noisy_world.h"

namespace scenes {

/// A ball, a box and a pole under a square lamp, whose shadows are sharp where they begin and soft
/// far from what casts them. Noisy: each sample asks one random point of the lamp for its light.
class SoftShadow final : public NoisyWorld {
 public:
  /// `width` and `height` in pixels, both > 0; any seed.
  SoftShadow(int width, int height, std::uint64_t seed);

 private:
  [[nodiscard]] View look(double x, double y, std::uint64_t id) const override;
};

}  // namespace scenes
