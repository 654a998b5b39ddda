// SPDX-License-Identifier: MIT
/// \file
/// The light that comes along rays of a camera: of a sun, a sky, and what both cast on what is
/// around.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "geometry.h"
#include "path_tracer/decisions.h"
#include "scene_options.h"
#include "scenes/camera.h"

namespace embree_host {

/// The channels of a sample: light; of the first surface its colour, its normal towards the eye,
/// and the share of the sun that it sees; its depth, along the ray, infinite where there is none.
inline constexpr std::array<std::string_view, 11> channel_names = {
    "R",        "G",        "B",        "albedo.R", "albedo.G", "albedo.B",
    "normal.X", "normal.Y", "normal.Z", "sun",      "Z"};
inline constexpr std::size_t channels = channel_names.size();

/// What shines.
struct Sky {
  Vec3 zenith{0.22, 0.38, 0.75};   ///< radiance straight up
  Vec3 horizon{0.75, 0.85, 1};     ///< and at the horizon
  Vec3 below{0.35, 0.32, 0.28};    ///< and below it
  Vec3 to_sun{0.62, -0.55, 0.56};  ///< direction
  Vec3 sun{2.9, 2.5, 1.9};         ///< what a surface that faces it gets; the disc is not seen
  double sun_radius = 0.0175;      ///< half the angle that it fills, in radians: 1 degree

  [[nodiscard]] Vec3 radiance(const Vec3& direction) const;
  /// The direction of a point of the sun.
  [[nodiscard]] Vec3 towards_sun(const std::array<double, 2>& chance) const;
};

/// Who a sample is, and how wide.
struct Sample {
  path_tracer::SampleName name;
  path_tracer::Numbers numbers = path_tracer::Numbers::sobol;
  float footprint = 1;  ///< pixels that it stands for; more than one count as one
};

/// Finds the light. Members may be called from several threads at the same time.
class Renderer {
 public:
  /// \param light_samples  paths from the first surface of each sample, >= 1
  Renderer(Geometry geometry, const View& view, const Sky& sky, std::size_t width,
           std::size_t height, std::uint32_t light_samples = 1);

  [[nodiscard]] const Geometry& geometry() const { return geometry_; }
  /// A ray through a position in pixels.
  [[nodiscard]] RTCRayHit camera_ray(double x, double y) const;

  /// What rays of the camera show that have met what they meet: `channels` values for each. The
  /// values of a sample depend on no other.
  void shade(std::span<const RTCRayHit> rays, std::span<const Sample> samples,
             std::span<float> values) const;

 private:
  Geometry geometry_;
  scenes::Camera camera_;
  Sky sky_;
  double pixel_;  // its width at distance 1
  std::uint32_t light_samples_;
};

/// The renderer of what the options name.
/// \throws UsageError when the camera looks straight up or down, and what read_obj() throws.
[[nodiscard]] Renderer make_renderer(const SceneOptions& options, std::size_t width,
                                     std::size_t height);

}  // namespace embree_host
