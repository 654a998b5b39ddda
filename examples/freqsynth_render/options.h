// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/shared_options.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/synthesis_settings.h"

/// In what the values of a pixel are averaged.
enum class Averaging : std::uint8_t {
  light,   ///< linear radiance, as a camera does
  display  ///< display-encoded values, as a JPEG holds them: clamped, sRGB
};

/// What the user asked for.
/// `samples_per_pixel` is infinite where the synthesis goes on until a target is met.
struct Options : SharedOptions {
  std::string scene = "chess";
  std::string density;        // empty: not wanted
  std::string error;          // of the expected errors; empty: not wanted
  std::string frames;         // a folder; empty: not wanted
  std::size_t reference = 0;  // jittered samples per pixel; 0: freqsynth
  double terms_every = 2.5;
  freqsynth::ButterworthSettings butterworth;
  freqsynth::PixelFilter pixel_filter = freqsynth::PixelFilter::box;
  bool no_residuals = false;
  double scale = 1;
  bool gray = false;
  std::optional<double> zone_frequency;
  Averaging averaging = Averaging::light;
  freqsynth::Steer steer = freqsynth::Steer::linear;
  freqsynth::RefinerKind refiner = freqsynth::RefinerKind::least_squares;
  int quality = 95;  // of a JPEG file
  freqsynth::Subsampling subsampling = freqsynth::Subsampling::none;
  bool direct = false;  // coefficients to JPEG, without pixels
  bool progressive = false;
  std::optional<int> until_quality;
  double tolerance = 0.25;
};

/// One line that shows the options that are always needed.
inline constexpr const char* usage_line =
    "freqsynth_render --scene NAME --size WxH --spp N -o FILE [options]";

/// Reads the command line. Empty when --help was asked for and printed.
/// \throws UsageError that names the option and its value.
std::optional<Options> parse_options(int argc, const char** argv);
