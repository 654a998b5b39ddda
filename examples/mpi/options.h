// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "common/shared_options.h"
#include "embree/scene_options.h"
#include "trial.h"

namespace farm {

/// Scenes of the host on Embree: the colonnade, and what OBJ files hold.
inline constexpr std::string_view colonnade = "colonnade", obj_prefix = "obj:";

/// What the user asked for. `samples_per_pixel` is infinite where `uniform` is not 0.
struct Options : SharedOptions {
  Options() { threads = 1; }

  std::string scene = "chess";
  embree_host::SceneOptions embree;
  std::size_t uniform = 0;            // samples of each block; 0: adaptive
  std::size_t columns = 0, rows = 0;  // of windows; 0: one engine
  TrialSettings trial;
};

/// Whether they name a scene of the host on Embree.
[[nodiscard]] bool is_embree_scene(const Options& options);

/// What picture they ask for, in words: two that differ may be different pictures.
[[nodiscard]] std::string picture_of(const Options& options);

inline constexpr const char* usage_line =
    "mpirun -n RANKS freqsynth_mpi --scene NAME --size WxH --spp N -o FILE [options]";

/// Reads the command line. Empty when --help was asked for; printed when `print`.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv, bool print);

}  // namespace farm
