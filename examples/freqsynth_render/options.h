#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "freqsynth/butterworth.h"
#include "freqsynth/reconstructor.h"
#include "option_values.h"

/// What the user asked for.
struct Options {
  std::string scene = "chess";
  std::size_t width = 512;
  std::size_t height = 512;
  double samples_per_pixel = 1;
  std::string output;
  std::string density;        // empty: not wanted
  std::string frames;         // a folder; empty: not wanted
  std::string stats;          // empty: not wanted
  std::size_t reference = 0;  // jittered samples per pixel; 0: freqsynth
  std::size_t wave = 0;       // 0: the library's choice
  std::uint64_t seed = 0;
  std::size_t threads = 0;  // 0: all
  double terms_every = 2.5;
  freqsynth::ButterworthSettings butterworth;
  freqsynth::PixelFilter pixel_filter = freqsynth::PixelFilter::box;
  bool no_residuals = false;
  double scale = 1;
  bool gray = false;
  std::optional<double> zone_frequency;
};

/// One line that shows the options that are always needed.
inline constexpr const char* usage_line =
    "freqsynth_render --scene fan|chess|zoneplate|image:FILE --size WxH --spp N -o FILE [options]";

/// Reads the command line. Empty when --help was asked for and printed.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv);
