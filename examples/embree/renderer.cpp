// SPDX-License-Identifier: MIT
#include "renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "common/option_values.h"
#include "path_tracer/scattering.h"

namespace embree_host {
namespace {

using path_tracer::Decisions;
using Bounce = Decisions::Bounce;

/// A footprint after a diffuse surface, as a share of the way: a look-up in a coarse level saves
/// noise, and is hardly seen.
constexpr double spread = 0.1;

/// A path from the first surface of a sample on.
struct Path {
  std::size_t sample = 0;
  Decisions decisions;
  Vec3 direction;  // that it leaves the first surface in
  Surface second;
};

void store(std::span<float> values, const Vec3& v) {
  values[0] = static_cast<float>(v.x);
  values[1] = static_cast<float>(v.y);
  values[2] = static_cast<float>(v.z);
}

}  // namespace

Vec3 Sky::radiance(const Vec3& direction) const {
  if (direction.z < 0) return below;
  return mix(horizon, zenith, std::sqrt(std::min(direction.z, 1.0)));
}

Vec3 Sky::towards_sun(const std::array<double, 2>& chance) const {
  // Uniform over the cap of the sphere.
  const double cosine = 1 - chance[0] * (1 - std::cos(sun_radius));
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double angle = 2 * std::numbers::pi * chance[1];
  const Vec3 middle = normalize(to_sun);
  const Vec3 side =
      normalize(cross(middle, std::abs(middle.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  return cosine * middle + sine * (std::cos(angle) * side + std::sin(angle) * cross(middle, side));
}

Renderer::Renderer(Geometry geometry, const View& view, const Sky& sky, std::size_t width,
                   std::size_t height, std::uint32_t light_samples)
    : geometry_(std::move(geometry)),
      camera_(view.eye, view.target, view.half_field, static_cast<double>(width),
              static_cast<double>(height)),
      sky_(sky),
      pixel_(2 * view.half_field / static_cast<double>(std::min(width, height))),
      light_samples_(light_samples) {}

RTCRayHit Renderer::camera_ray(double x, double y) const {
  const scenes::Ray ray = camera_.ray(x, y);
  return Geometry::question(ray.origin, ray.direction);
}

void Renderer::shade(std::span<const RTCRayHit> rays, std::span<const Sample> samples,
                     std::span<float> values) const {
  // All rays of a kind go to Embree together, which makes packets of them.
  std::vector<Surface> first(rays.size());
  std::vector<Path> paths;
  std::vector<RTCRay> to_light;
  std::vector<RTCRayHit> bounces;
  paths.reserve(rays.size() * light_samples_);
  to_light.reserve(2 * rays.size() * light_samples_);
  bounces.reserve(rays.size() * light_samples_);
  const auto above = [&](const Surface& surface) {
    return surface.point + geometry_.margin() * surface.face;
  };

  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::span<float> out = values.subspan(i * channels, channels);
    std::fill(out.begin(), out.end(), 0.0f);
    out[10] = std::numeric_limits<float>::infinity();
    if (!Geometry::met(rays[i])) {
      const RTCRay& ray = rays[i].ray;
      store(out, sky_.radiance({double{ray.dir_x}, double{ray.dir_y}, double{ray.dir_z}}));
      continue;
    }
    const double distance = double{rays[i].ray.tfar};
    // The first samples of a block stand for more than a pixel, but stay in the picture.
    const double footprint = std::min(double{samples[i].footprint}, 1.0);
    first[i] = geometry_.surface(rays[i], footprint * pixel_ * distance);
    store(out.subspan(3), first[i].colour);
    store(out.subspan(6), first[i].normal);
    out[10] = rays[i].ray.tfar;
    for (std::uint32_t k = 0; k < light_samples_; ++k) {
      path_tracer::SampleName name = samples[i].name;
      name.ordinal = name.ordinal * light_samples_ + k;
      name.seed = scenes::mix_bits(name.seed + k);
      Path path{i, Decisions(samples[i].numbers, name), {}, {}};
      const auto place = path.decisions.pair(Decisions::at(0, Bounce::place_on_light));
      const auto turn = path.decisions.pair(Decisions::at(0, Bounce::direction));
      path.direction = path_tracer::diffuse_direction(first[i].normal, turn);
      to_light.push_back(Geometry::ray(above(first[i]), sky_.towards_sun(place)));
      bounces.push_back(Geometry::question(above(first[i]), path.direction));
      paths.push_back(path);
    }
  }
  geometry_.find(to_light);
  geometry_.find(bounces);

  const double share = 1 / static_cast<double>(light_samples_);
  std::vector<Vec3> light(rays.size());
  const auto direction_of = [](const RTCRay& ray) {
    return Vec3{double{ray.dir_x}, double{ray.dir_y}, double{ray.dir_z}};
  };
  /// Light of the sun that a surface scatters, unless the ray to it has met something.
  const auto sunlight = [&](const Surface& surface, const RTCRay& ray) {
    const Vec3 direction = direction_of(ray);
    const double cosine = dot(surface.normal, direction);
    if (ray.tfar < 0 || cosine <= 0 || dot(surface.face, direction) <= 0) return Vec3{};
    return cosine / std::numbers::pi * (surface.colour * sky_.sun);
  };

  std::vector<RTCRay> from_second;
  from_second.reserve(2 * paths.size());
  for (std::size_t k = 0; k < paths.size(); ++k) {
    Path& path = paths[k];
    const Surface& surface = first[path.sample];
    light[path.sample] = light[path.sample] + share * sunlight(surface, to_light[k]);
    if (to_light[k].tfar >= 0 && dot(surface.face, direction_of(to_light[k])) > 0) {
      values[path.sample * channels + 9] += static_cast<float>(share);
    }
    if (!Geometry::met(bounces[k])) {
      if (dot(surface.face, path.direction) > 0) {
        light[path.sample] =
            light[path.sample] + share * (surface.colour * sky_.radiance(path.direction));
      }
      continue;
    }
    path.second = geometry_.surface(bounces[k], spread * double{bounces[k].ray.tfar});
    const auto place = path.decisions.pair(Decisions::at(1, Bounce::place_on_light));
    const auto turn = path.decisions.pair(Decisions::at(1, Bounce::direction));
    from_second.push_back(Geometry::ray(above(path.second), sky_.towards_sun(place)));
    from_second.push_back(Geometry::ray(above(path.second),
                                        path_tracer::diffuse_direction(path.second.normal, turn)));
  }
  geometry_.find(from_second);

  std::size_t next = 0;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    if (!Geometry::met(bounces[k])) continue;
    const Path& path = paths[k];
    const RTCRay& to_sun = from_second[next++];
    const RTCRay& to_sky = from_second[next++];
    Vec3 arriving = sunlight(path.second, to_sun);
    const Vec3 direction = direction_of(to_sky);
    if (to_sky.tfar >= 0 && dot(path.second.face, direction) > 0) {
      arriving = arriving + path.second.colour * sky_.radiance(direction);
    }
    const Surface& surface = first[path.sample];
    if (dot(surface.face, path.direction) <= 0) continue;
    light[path.sample] = light[path.sample] + share * (surface.colour * arriving);
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (Geometry::met(rays[i])) store(values.subspan(i * channels), light[i]);
  }
}

Renderer make_renderer(const SceneOptions& options, std::size_t width, std::size_t height) {
  View view;
  Model model = options.obj.empty() ? make_colonnade(view) : read_obj(options.obj, view);
  if (options.eye) view.eye = *options.eye;
  if (options.target) view.target = *options.target;
  if (options.half_field) view.half_field = *options.half_field;
  const Vec3 forward = view.target - view.eye;
  if (forward.x == 0 && forward.y == 0) {
    throw UsageError("--target: is above or below --eye, or in the same place");
  }
  Sky sky;
  sky.sun_radius = options.sun_size * std::numbers::pi / 360;
  return Renderer(Geometry(std::move(model)), view, sky, width, height, options.light_samples);
}

}  // namespace embree_host
