// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// What the user asked for.
struct Options {
  std::vector<std::string> scenes;   // empty: all that need no file
  std::vector<std::string> methods;  // empty: all
  std::vector<double> rates;         // samples per pixel
  std::size_t width = 256;
  std::size_t height = 256;
  std::size_t seeds = 1;         // runs that a figure is the mean of
  std::size_t reference = 1024;  // samples per pixel
  std::size_t threads = 0;       // 0: all
  std::string cache;             // a folder; empty: references are not kept
  std::string csv;               // empty: standard output
  std::string pictures;          // a folder; empty: not wanted
  bool list = false;
  bool noisy = false;  // a table of the noisy scenes instead of the results
};

/// One line that shows what is always needed: nothing.
inline constexpr const char* usage_line =
    "freqsynth_quality [--scenes A,B] [--methods A,B] [--spp 1/4,1,4] [--csv FILE] [options]";

/// Reads the command line. Empty when --help was asked for and printed.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv);
