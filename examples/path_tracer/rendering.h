// SPDX-License-Identifier: MIT
/// \file
/// Pictures of a scene: by freqsynth, and plainly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "scene.h"

namespace path_tracer {

/// The channels of a picture. freqsynth chooses samples by the first three alone.
inline constexpr std::array<std::string_view, 10> channel_names = {
    "R",        "G",        "B",        "colour.R", "colour.G",
    "colour.B", "normal.X", "normal.Y", "normal.Z", "nearness"};
inline constexpr std::size_t channels = channel_names.size();

/// Linear values, row by row, the channels of a pixel side by side.
using Pixels = std::vector<float>;

/// What is to be rendered.
struct Job {
  std::size_t width = 0;
  std::size_t height = 0;
  double samples_per_pixel = 1;
  std::uint64_t frame = 0;  ///< pictures of other frames have other noise
};

/// By freqsynth, which says where to sample; paths take Sobol points by the ordinal of the sample
/// in its pixel.
[[nodiscard]] Pixels render_adaptively(const Scene& scene, const Job& job,
                                       freqsynth::ThreadPool& pool);

/// As many samples in each pixel, and their means. Random numbers come with a jittered grid, Sobol
/// points with Sobol points.
/// \throws std::invalid_argument when the number of samples per pixel is not a whole one.
[[nodiscard]] Pixels render_plainly(const Scene& scene, const Job& job, Numbers numbers,
                                    freqsynth::ThreadPool& pool);

}  // namespace path_tracer
