// SPDX-License-Identifier: MIT
/// \file
/// The interface of the scenes and how to get one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

/// Ready-made things to look at, for examples, tests and benchmarks. A scene is a plain function
/// from a position on the image plane to a radiance. It knows nothing of the engine that samples
/// it.
namespace scenes {

/// The id of sample number `ordinal` (below 2^24) of a sequence of samples, such as those of a
/// pixel. Of the sequence's number 40 bits count.
[[nodiscard]] constexpr std::uint64_t sample_id(std::uint64_t sequence, std::uint64_t ordinal) {
  return (sequence << 24) + ordinal;
}

/// Features of a surface: colour, normal and nearness.
inline constexpr std::size_t feature_count = 7;

/// A radiance function over an image of a fixed size.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Stores the linear radiance (red, green, blue; finite and >= 0) seen at the continuous pixel
  /// position (x, y) in `rgb`. x grows to the right in [0, width], y grows downwards in [0,
  /// height], and pixel (i, j) is centred at (i + 0.5, j + 0.5).
  ///
  /// A point sample, without a filter. `id` names the sample, see sample_id(). A scene that is not
  /// noisy() ignores it; a noisy one takes all its random decisions from it and SceneOptions::seed,
  /// and the mean of its values over all ids is the radiance. Decisions of different sequences are
  /// independent; those of a sequence are evenly spread, so that samples near each other have less
  /// noise together when they are the first ones of the same sequence. The same arguments always
  /// give the same value. Safe to call from any number of threads at once.
  virtual void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const = 0;

  /// Whether radiance() is a Monte Carlo estimate, whose value depends on the sample's id.
  [[nodiscard]] virtual bool noisy() const { return false; }

  /// Number of features that the scene tells of what a sample meets first: feature_count in noisy
  /// scenes of solids, otherwise 0.
  [[nodiscard]] virtual std::size_t features() const { return 0; }

  /// Stores what radiance() does, and behind it features() values of the first surface on the same
  /// way: its colour (3), the share of light that it scatters; its normal (3), of unit length, on
  /// the side of the ray; its nearness, 1 over the distance. All are finite, and 0 where there is
  /// no surface. `values` has room for 3 + features().
  virtual void radiance_and_features(double x, double y, std::uint64_t id,
                                     std::span<float> values) const {
    radiance(x, y, id, values.first<3>());
  }

  /// Stores the mean radiance over the area of pixel (i, j) in `rgb` and returns true where it is
  /// known in closed form, or by a quadrature with an error below 1e-8, and then rounded. Otherwise
  /// returns false and leaves `rgb` as it is. i is in [0, width), j in [0, height).
  [[nodiscard]] virtual bool pixel_average(long i, long j, std::span<float, 3> rgb) const;
};

/// What make_scene() is to make.
struct SceneOptions {
  /// One of scene_names(), or `image:FILE`.
  std::string name = "chess";
  /// Size of the image in pixels, both > 0. Every scene fits itself to this size.
  int width = 512;
  int height = 512;
  /// `zoneplate` only: the local frequency at the corner opposite the centre, in cycles per pixel,
  /// finite and >= 0. 0.5 is the limit that one sample per pixel can represent; the default stays
  /// below it, so that all aliasing in a picture is the sampler's fault.
  double zone_frequency = 0.4;
  /// Noisy scenes only: other seeds give other noise, but the same mean.
  std::uint64_t seed = 0;
};

/// Makes a scene:
///
/// * `fan`            a resolution fan of hard black and white lines that converge downwards
/// * `chess`          a ray-traced chess board with all its pieces
/// * `zoneplate`      cosine rings whose frequency grows linearly with the distance from a corner
/// * `zoneplate-high` the same, up to 0.8 cycles per pixel: more than the pixels can hold
/// * `star`           a Siemens star of hard black and white spokes
/// * `edge`           a slanted black and white edge
/// * `checker`        a checkered floor in perspective, up to the horizon
/// * `gradient`       smooth colour gradients without any edge
/// * `dot`            a few bright dots, smaller than a pixel, on mid gray
/// * `corner`         black, but for one small lit corner
/// * `sun`            a low sun, a thousand times as bright as the sky, behind a forest's
/// silhouette
/// * `softshadow`     solids under a lamp with an area (noisy)
/// * `dof`            a row of balls, of which a lens has one in focus (noisy)
/// * `glossy`         balls that are mirrored in a brushed floor (noisy)
/// * `cornell`        a box with a ball of glass and a small lamp, by a path tracer (noisy)
/// * `spheres`        balls, some of them moving, before a lens, by a path tracer (noisy)
/// * `image:FILE`     a picture that OpenImageIO can read, stretched over the image
///
/// Throws std::invalid_argument, naming the value, for an unknown name, a size that is not
/// positive, or a bad zone frequency. Throws std::runtime_error, naming the file and the reason,
/// for a picture that cannot be read.
[[nodiscard]] std::unique_ptr<Scene> make_scene(const SceneOptions& options);

/// The names that make_scene() takes, without `image:FILE`, which needs a file.
[[nodiscard]] std::span<const std::string_view> scene_names();

/// All that make_scene() takes, as a list to read: "fan, chess, ..., image:FILE".
[[nodiscard]] std::string scene_list();

}  // namespace scenes
