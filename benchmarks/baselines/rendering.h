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

/// The same for a sampler that knows more of a sample than its radiance: what Job::features counts
/// comes behind the three values. A call counts as one of the radiance function.
using FeaturedRadiance =
    std::function<void(double x, double y, std::uint64_t id, std::span<float> values)>;

/// What to render.
struct Job {
  std::size_t width = 0;      ///< pixels, at least 1
  std::size_t height = 0;     ///< pixels, at least 1
  std::uint64_t samples = 0;  ///< calls of the radiance function that are allowed, at least 1
  std::uint64_t seed = 0;     ///< of all random choices
  /// The radiance function is a Monte Carlo estimate that depends on the id. A host knows this; a
  /// method may use it.
  bool noisy = false;
  /// Values of the first surface that a sample meets: its colour (3), its normal (3), and 1 over
  /// the distance, all 0 where there is none. 0: not known; else 7.
  std::size_t features = 0;
  FeaturedRadiance radiance_and_features = {};  ///< for samples with features, where there are any
};

/// A picture and what it cost.
struct Rendering {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<float> pixels;           ///< linear RGB, interleaved, row by row
  std::vector<std::uint32_t> samples;  ///< calls of the radiance function in each pixel
};

}  // namespace baselines
