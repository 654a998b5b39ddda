// SPDX-License-Identifier: MIT
/// \file
/// The methods to compare, and one fair run of one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "baselines/methods.h"
#include "baselines/rendering.h"

namespace quality {

/// A way to make a picture out of a number of samples.
using baselines::Method;

/// freqsynth, freqsynth-paper, and all systems of benchmarks/baselines.
[[nodiscard]] std::span<const Method> methods();

/// \throws std::invalid_argument naming the name and the valid ones when there is no such method.
[[nodiscard]] const Method& find_method(std::string_view name);

/// A picture, and what it cost by the laboratory's own count.
struct Run {
  std::vector<float> pixels;           ///< linear RGB, interleaved, row by row
  std::vector<std::uint32_t> samples;  ///< calls of the radiance function in each pixel
  std::uint64_t calls = 0;             ///< of the radiance function
  /// Processor time of the run, tables and calls of the radiance function included.
  double seconds = 0;
  /// Processor time of the calls of the radiance function. It is estimated, since a clock around
  /// each call would cost more than many calls do: the positions, or when there are many an even
  /// part of at least 65,536, are called again after the run, twice, and the shorter time is
  /// scaled to all calls. They find the caches warmer, so that it is a little too low.
  double sampler_seconds = 0;
};

/// Runs a method on the calling thread. A position on the border of two pixels counts for the right
/// or lower one, where there is one.
/// \throws std::runtime_error naming the method when it calls the radiance function more often than
///         job.samples allows or outside the picture, or returns a picture of another size.
[[nodiscard]] Run run_method(const Method& method, const baselines::Radiance& radiance,
                             const baselines::Job& job);

/// \return the number of samples of a rate in samples per pixel, at least 1
[[nodiscard]] std::uint64_t samples_of(double rate, std::size_t width, std::size_t height);

}  // namespace quality
