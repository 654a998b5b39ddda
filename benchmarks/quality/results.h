// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "quality/metrics.h"

namespace quality {

/// A line of the results: means over the seeds, but for times, which are the least: other programs
/// only ever make them longer.
struct Result {
  std::string scene;
  std::string method;
  double rate = 0;  ///< samples per pixel that were allowed
  std::size_t width = 0, height = 0, seeds = 0;
  double samples = 0;  ///< calls of the radiance function
  Metrics metrics;
  double rmse_deviation = 0;       ///< standard deviation of the RMSE over the seeds
  std::size_t reference_rate = 0;  ///< samples per pixel of the reference
  double reference_error = 0;      ///< see Reference::standard_error()
  double core_seconds = 0;         ///< processor time without the radiance function, see Run
  double sampler_seconds = 0;      ///< processor time of the radiance function, see Run
};

/// Comma-separated values, with a line of names. Times come last: all else is the same on every
/// run.
[[nodiscard]] std::string to_csv(std::span<const Result> results);

/// `name` with all characters but letters, digits, '-' and '.' replaced by '_'.
[[nodiscard]] std::string file_name(const std::string& name);

/// A rate as a part of a file's name: 1_16, 4, 2.5.
[[nodiscard]] std::string rate_name(double rate);

}  // namespace quality
