// SPDX-License-Identifier: MIT
/// \file
/// What the noisy scenes of solids have in common.
#pragma once

#include <cstdint>
#include <utility>

#include "camera.h"
#include "freqsynth/basis/owen_sobol.h"
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

  /// Where the random decision of a sample falls: two numbers in (0, 1).
  [[nodiscard]] freqsynth::OwenSobol decision(std::uint64_t id) const {
    return {id >> 24, static_cast<std::uint32_t>(id & 0xffffff), seed_};
  }

  SolidWorld world_;
  Camera camera_;

 private:
  std::uint64_t seed_;
};

}  // namespace scenes
