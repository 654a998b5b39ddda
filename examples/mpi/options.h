// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "trial.h"

namespace farm {

/// What the user asked for.
struct Options {
  std::string scene = "chess";
  std::size_t width = 512;
  std::size_t height = 512;
  double samples_per_pixel = 1;
  std::size_t uniform = 0;  // samples of each block; 0: adaptive
  std::string output;
  std::string stats;             // empty: not wanted
  std::string checkpoint;        // a file for the state of the run; empty: not wanted
  double checkpoint_every = 60;  // seconds
  std::string resume;            // a file to go on from; empty: from the beginning
  std::size_t wave = 0;          // 0: the library's choice
  std::uint64_t seed = 0;
  std::size_t threads = 1;            // of each rank
  std::size_t columns = 0, rows = 0;  // of windows; 0: one engine
  TrialSettings trial;
};

inline constexpr const char* usage_line =
    "mpirun -n RANKS freqsynth_mpi --scene NAME --size WxH --spp N -o FILE [options]";

/// Reads the command line. Empty when --help was asked for; printed when `print`.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv, bool print);

}  // namespace farm
