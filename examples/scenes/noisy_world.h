// SPDX-License-Identifier: MIT
/// \file
/// What the noisy scenes of solids have in common.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "camera.h"
#include "freqsynth/basis/owen_sobol.h"
#include "scene.h"
#include "solid_world.h"

namespace scenes {

/// Solids before a camera, sampled with one random decision each time.
class NoisyWorld : public Scene {
 public:
  [[nodiscard]] bool noisy() const final { return true; }
  [[nodiscard]] std::size_t features() const final { return feature_count; }

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const final {
    store(look(x, y, id).light, rgb);
  }
  void radiance_and_features(double x, double y, std::uint64_t id,
                             std::span<float> values) const final {
    const auto [light, surface] = look(x, y, id);
    store(light, values.first<3>());
    store(surface ? surface->color : Vec3{}, values.subspan<3, 3>());
    store(surface ? surface->normal : Vec3{}, values.subspan<6, 3>());
    values[9] = surface ? static_cast<float>(1.0 / surface->t) : 0.0f;
  }

 protected:
  /// What a sample sees, and the surface that it meets first.
  struct View {
    Vec3 light;
    std::optional<SolidWorld::Surface> surface;
  };
  [[nodiscard]] virtual View look(double x, double y, std::uint64_t id) const = 0;

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
