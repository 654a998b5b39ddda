// SPDX-License-Identifier: MIT
/// \file
/// A state of the picture as those who look at it get it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "freqsynth/freqsynth.h"

namespace live {

/// How the picture is shown.
struct View {
  double stops = 0;  ///< log2 of the exposure, -8..8
  int quality = 75;  ///< of JPEG, 1..100
};

/// The bytes of JPEG files, and what is said beside them.
struct Revision {
  std::uint64_t number = 0;  ///< from 1 on
  std::string picture;       ///< progressive
  std::string density;       ///< samples of blocks: their root, white where there are most
  std::string error;         ///< expected errors of blocks: their root, white from `most_error` on
  std::uint32_t most_samples = 0;  ///< of a block
  std::uint64_t samples = 0;
  double samples_per_pixel = 0;
  double seconds = 0;          ///< since the start
  double predicted_error = 0;  ///< root mean square, of 255 levels as shown; below 0: not yet known
  View view;
  bool finished = false;  ///< sampling has ended, and these are finished pixels
};

/// An error, of 255 levels, that is shown as white.
inline constexpr double most_error = 64;

/// A progressive JPEG file of the coefficients of `image`, see shown_light.h. No pixel is made.
[[nodiscard]] std::string picture_jpeg(const freqsynth::FrequencyImage& image, const View& view);

/// The samples of the blocks of an image, a pixel for each.
/// \param most  gets the most that a block has
[[nodiscard]] std::string density_jpeg(const freqsynth::FrequencyImage& image, std::uint32_t& most);

/// The error that each block is expected to have as it is shown, a pixel for each.
[[nodiscard]] std::string error_jpeg(const freqsynth::Synthesizer& engine, const View& view);

}  // namespace live
