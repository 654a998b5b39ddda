// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

namespace live {

inline constexpr const char* usage_line = "freqsynth_live [--scene NAME] [-o STEM] [options]";

/// What the user asked for.
struct Options {
  std::string scene = "chess";
  std::size_t width = 512;
  std::size_t height = 512;
  double samples_per_pixel = std::numeric_limits<double>::infinity();
  std::size_t threads = 0;         ///< 0: all
  std::string stem = "live";       ///< of the files that are stored: STEM.jpg, STEM.exr, STEM.state
  std::string resume;              ///< empty: from the beginning
  std::string host = "127.0.0.1";  ///< address to listen on
  std::string name;      ///< that browsers call it by, beside the address and those of this machine
  unsigned port = 8000;  ///< 0: any that is free
  std::size_t measure = 0;  ///< runs that are measured; 0: no measurement

  [[nodiscard]] std::string jpeg_file() const { return stem + ".jpg"; }
  [[nodiscard]] std::string exr_file() const { return stem + ".exr"; }
  [[nodiscard]] std::string state_file() const { return stem + ".state"; }
};

/// Reads the command line. Empty when --help was asked for and printed.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv);

}  // namespace live
