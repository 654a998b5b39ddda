// SPDX-License-Identifier: MIT
#pragma once

#include <OpenImageIO/argparse.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/sampler.h"
#include "option_values.h"
#include "scenes/scene.h"

/// Has a parser know `--scene NAME`, one of scenes::scene_names() or a picture.
/// \param others  names that this program knows as well, each followed by ", "
inline void describe_scene(OIIO::ArgParse& parser, std::string& scene,
                           const std::string& others = {}) {
  parser.arg("--scene %s:NAME", &scene).help(others + scenes::scene_list() + " (" + scene + ")");
}

/// \throws UsageError when there is no such scene.
inline std::unique_ptr<scenes::Scene> named_scene(const scenes::SceneOptions& options) {
  try {
    return scenes::make_scene(options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--scene: ") + error.what());
  }
}

/// The scene's value at (x, y) in pixels: 3 channels, or 1 for its luminance (Rec. 709). `id` names
/// the sample.
inline void sample_scene(const scenes::Scene& scene, double x, double y, std::uint64_t id,
                         std::span<float> value) {
  std::array<float, 3> rgb{};
  scene.radiance(x, y, id, rgb);
  if (value.size() == 1) {
    value[0] = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
  } else {
    std::copy(rgb.begin(), rgb.end(), value.begin());
  }
}

/// A scene as the engine asks for it, in batches.
class SceneSampler {
 public:
  /// \param channels  3, or 1 for the luminance
  SceneSampler(const scenes::Scene& scene, std::size_t channels)
      : scene_(scene), channels_(channels) {}

  /// Values of the requests, of which x, y, pixel and ordinal count.
  void operator()(std::span<const freqsynth::Request> requests, std::span<float> values) const {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      sample_scene(scene_, requests[i].x, requests[i].y,
                   scenes::sample_id(requests[i].pixel, requests[i].ordinal),
                   values.subspan(i * channels_, channels_));
    }
  }

 private:
  const scenes::Scene& scene_;
  std::size_t channels_;
};

/// Most samples of a block of a picture with `samples_per_pixel` on average: room for four times as
/// many, and no less than `least`.
inline std::size_t block_limit(double samples_per_pixel, std::size_t least) {
  if (!std::isfinite(samples_per_pixel)) return least;
  constexpr auto most = static_cast<double>(freqsynth::SampleSequence::max_size);
  return std::max(least, static_cast<std::size_t>(std::min(4 * 64 * samples_per_pixel, most)));
}
