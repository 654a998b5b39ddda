// SPDX-License-Identifier: MIT
/// \file
/// What every system of the survey takes and gives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

/// The systems of the paper's survey (section 3), small and readable, to compare with.
namespace baselines {

/// Stores the linear radiance (red, green, blue) at (x, y), in pixels, in `rgb`. `id` names the
/// sample: a Monte Carlo scene takes its random decisions from it. The upper 40 bits name the
/// pixel, the lower 24 count its samples; so every sample of a picture has an id of its own.
using Radiance = std::function<void(double x, double y, std::uint64_t id, std::span<float, 3> rgb)>;

/// What to render.
struct Job {
  std::size_t width = 0;      ///< pixels, at least 1
  std::size_t height = 0;     ///< pixels, at least 1
  std::uint64_t samples = 0;  ///< calls of the radiance function that are allowed, at least 1
  std::uint64_t seed = 0;     ///< of all random choices
  /// The radiance function is a Monte Carlo estimate that depends on the id. A host knows this; a
  /// method may use it.
  bool noisy = false;
};

/// A picture and what it cost.
struct Rendering {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<float> pixels;           ///< linear RGB, interleaved, row by row
  std::vector<std::uint32_t> samples;  ///< calls of the radiance function in each pixel
};

}  // namespace baselines
