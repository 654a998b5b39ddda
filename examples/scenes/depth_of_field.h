// SPDX-License-Identifier: MIT
/// \file
/// The `dof` scene.
#pragma once

#include "noisy_world.h"

namespace scenes {

/// A row of balls on a checkered floor seen through a thin lens: the second is in focus, what is
/// nearer or farther blurs. Noisy: each sample looks through one random point of the lens.
class DepthOfField final : public NoisyWorld {
 public:
  /// `width` and `height` in pixels, both > 0; any seed.
  DepthOfField(int width, int height, std::uint64_t seed);

 private:
  [[nodiscard]] View look(double x, double y, std::uint64_t id) const override;
};

}  // namespace scenes
