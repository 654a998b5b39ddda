// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "common/shared_options.h"
#include "scene_options.h"

namespace embree_host {

inline constexpr const char* usage_line = "freqsynth_embree -o FILE [options]";

/// What the user asked for.
struct Options : SharedOptions {
  Options() {
    width = 960;
    height = 540;
    samples_per_pixel = 4;
  }
  SceneOptions scene;
};

/// Reads the command line. Empty when --help was asked for and printed.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv);

}  // namespace embree_host
