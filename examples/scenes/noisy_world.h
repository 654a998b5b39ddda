// SPDX-License-Identifier: MIT
/// \file
/// What the noisy scenes of solids have in common.
#pragma once

#include <cstdint>
#include <utility>

#include "camera.h"
#include "scene.h"
#include "solid_world.h"

namespace scenes {

/// Solids before a camera, sampled with one random decision each time.
class NoisyWorld : public Scene {
 public:
  [[nodiscard]] bool noisy() const override { return true; }

 protected:
  NoisyWorld(SolidWorld world, const Camera& camera, std::uint64_t seed)
      : world_(std::move(world)), camera_(camera), seed_(seed) {}

  SolidWorld world_;
  Camera camera_;
  std::uint64_t seed_;
};

}  // namespace scenes
