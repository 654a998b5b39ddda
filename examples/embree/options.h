// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "rendering.h"

namespace embree_host {

inline constexpr const char* usage_line = "freqsynth_embree -o FILE [options]";

/// What the user asked for.
struct Options {
  std::string obj;  ///< empty: the colonnade
  std::string sampler = "freqsynth";
  std::string output;
  Job job{.width = 960, .height = 540, .samples_per_pixel = 4};
  std::optional<Vec3> eye, target;
  std::optional<double> half_field;
  double sun_size = 2;  ///< degrees
  std::uint32_t light_samples = 1;
  std::size_t threads = 0;       ///< 0: all
  std::string checkpoint;        ///< empty: none
  double checkpoint_every = 60;  ///< seconds
  std::string resume;            ///< empty: from the beginning
};

/// Reads the command line. Empty when --help was asked for and printed.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv);

}  // namespace embree_host
