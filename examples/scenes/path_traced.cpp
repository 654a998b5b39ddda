// SPDX-License-Identifier: MIT
#include "path_traced.h"

#include "random.h"

namespace scenes {

PathTraced::PathTraced(std::string_view name, int width, int height, std::uint64_t seed)
    : scene_(path_tracer::make_scene(name, static_cast<std::size_t>(width),
                                     static_cast<std::size_t>(height))),
      seed_(seed) {}

path_tracer::PathSample PathTraced::sample(double x, double y, std::uint64_t id) const {
  const path_tracer::SampleName name{id >> 24, static_cast<std::uint32_t>(id & 0xffffff),
                                     mix_bits(mix_bits(seed_) + id), seed_};
  return scene_.sample(x, y, {path_tracer::Numbers::sobol, name});
}

void PathTraced::radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const {
  store(sample(x, y, id).radiance, rgb);
}

void PathTraced::radiance_and_features(double x, double y, std::uint64_t id,
                                       std::span<float> values) const {
  const auto [light, color, normal, nearness] = sample(x, y, id);
  store(light, values.first<3>());
  store(color, values.subspan<3, 3>());
  store(normal, values.subspan<6, 3>());
  values[9] = static_cast<float>(nearness);
}

}  // namespace scenes
