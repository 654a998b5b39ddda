// SPDX-License-Identifier: MIT
#include "path.h"

#include <algorithm>
#include <numbers>

#include "scattering.h"

namespace path_tracer {
namespace {

using Bounce = Decisions::Bounce;

constexpr unsigned most_surfaces = 64;
constexpr unsigned sure_surfaces = 3;  // before a path may end by chance

/// Radiance of one random point of the lights, as the diffuse surface scatters it.
/// \param facing  the surface's normal on the path's side
Vec3 asked_light(const World& world, const Surface& surface, const Vec3& facing, double time,
                 const Decisions& decisions, unsigned depth) {
  const auto count = static_cast<double>(world.lights());
  const double which = decisions.pair(Decisions::at(depth, Bounce::light))[0];
  const Rectangle& light =
      world.light(std::min(static_cast<std::size_t>(which * count), world.lights() - 1));
  const auto place = decisions.pair(Decisions::at(depth, Bounce::place_on_light));
  const Vec3 to_light =
      light.corner + place[0] * light.across + place[1] * light.up - surface.point;
  const double square = dot(to_light, to_light);
  if (square == 0) return {};
  const double distance = std::sqrt(square);
  const Vec3 direction = (1 / distance) * to_light;
  const double at_surface = dot(facing, direction);
  const double at_light = -dot(light.normal(), direction);
  if (at_surface <= 0 || at_light <= 0) return {};
  if (world.is_hidden({surface.point, direction}, time, distance * (1 - 1e-9) - least_distance)) {
    return {};
  }
  const double factor = count * light.area() * at_surface * at_light / (std::numbers::pi * square);
  return factor * (surface.material->colour * light.material.emission);
}

}  // namespace

PathSample trace(const World& world, const Ray& first, double time, const Decisions& decisions,
                 const PathSettings& settings) {
  PathSample sample;
  Ray ray = first;
  Vec3 weight{1, 1, 1};
  bool was_asked = false;  // whether the last surface has asked the lights
  for (unsigned depth = 0; depth < most_surfaces; ++depth) {
    const std::optional<Surface> surface = world.find(ray, time);
    if (!surface) {
      sample.radiance = sample.radiance + weight * world.sky(ray.direction);
      break;
    }
    const Material& material = *surface->material;
    const bool front = dot(ray.direction, surface->normal) < 0;
    if (depth == 0) {
      sample.colour = material.colour;
      sample.normal = front ? surface->normal : -surface->normal;
      sample.nearness = 1 / surface->distance;
    }
    if (front && !was_asked) sample.radiance = sample.radiance + weight * material.emission;

    const auto chance = decisions.pair(Decisions::at(depth, Bounce::direction));
    Vec3 direction;
    was_asked = false;
    if (material.scattering == Scattering::diffuse) {
      const Vec3 facing = front ? surface->normal : -surface->normal;
      if (settings.ask_lights && world.lights() > 0) {
        sample.radiance =
            sample.radiance + weight * asked_light(world, *surface, facing, time, decisions, depth);
        was_asked = true;
      }
      direction = diffuse_direction(facing, chance);
    } else if (material.scattering == Scattering::mirror) {
      direction = mirrored(ray.direction, surface->normal);
    } else {
      direction = glass_direction(ray.direction, surface->normal, chance[0]);
    }
    weight = weight * material.colour;
    ray = {surface->point, direction};
    if (depth + 1 < sure_surfaces) continue;
    const double survival = std::min(1.0, std::max({weight.x, weight.y, weight.z}));
    if (decisions.pair(Decisions::at(depth, Bounce::survival))[0] >= survival) break;
    weight = (1 / survival) * weight;
  }
  return sample;
}

}  // namespace path_tracer
