/// \file
/// The interface of the scenes and how to get one.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

/// Ready-made things to look at, for examples, tests and benchmarks. A scene is a plain function
/// from a position on the image plane to a radiance. It knows nothing of the library that samples
/// it.
namespace scenes {

/// A radiance function over an image of a fixed size.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Stores the linear radiance (red, green, blue; finite and >= 0) seen at the continuous pixel
  /// position (x, y) in `rgb`. x grows to the right in [0, width], y grows downwards in [0,
  /// height], and pixel (i, j) is centred at (i + 0.5, j + 0.5).
  ///
  /// A point sample: no filter, no randomness. The same position always gives the same value. Safe
  /// to call from any number of threads at once.
  virtual void radiance(double x, double y, std::span<float, 3> rgb) const = 0;
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
};

/// Makes a scene:
///
/// * `fan`        a resolution fan of hard black and white lines that converge downwards
/// * `chess`      a ray-traced chess board with all its pieces
/// * `zoneplate`  cosine rings whose frequency grows linearly with the distance from a corner
/// * `image:FILE` a picture that OpenImageIO can read, stretched over the image
///
/// Throws std::invalid_argument, naming the value, for an unknown name, a size that is not
/// positive, or a bad zone frequency. Throws std::runtime_error, naming the file and the reason,
/// for a picture that cannot be read.
[[nodiscard]] std::unique_ptr<Scene> make_scene(const SceneOptions& options);

/// The names that make_scene() takes, without `image:FILE`, which needs a file.
[[nodiscard]] std::span<const std::string_view> scene_names();

}  // namespace scenes
