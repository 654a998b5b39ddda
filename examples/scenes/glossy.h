// SPDX-License-Identifier: MIT
/// \file
/// The `glossy` scene.
#pragma once

#include "noisy_world.h"

namespace scenes {

/// Balls and a box on a brushed floor that mirrors them, sharply where they touch it and blurred
/// farther up; they mirror it in turn, a little. Noisy: each sample follows one random direction
/// about that of the mirror.
class Glossy final : public NoisyWorld {
 public:
  /// `width` and `height` in pixels, both > 0; any seed.
  Glossy(int width, int height, std::uint64_t seed);

 private:
  [[nodiscard]] View look(double x, double y, std::uint64_t id) const override;
};

}  // namespace scenes
