// SPDX-License-Identifier: MIT
/// \file
/// A state of the picture as those who look at it get it.
#pragma once

#include <cstdint>
#include <vector>

#include "glue.h"

namespace live {

/// The bytes of JPEG files, and what is said beside them.
struct Revision {
  std::uint64_t number = 0;           ///< from 1 on
  std::vector<std::uint8_t> picture;  ///< progressive
  std::vector<std::uint8_t> density;  ///< the root of the samples of blocks
  std::vector<std::uint8_t> error;    ///< the root of their expected errors; empty: not yet known
  std::uint32_t most_samples = 0;     ///< of a block, and white in `density`
  std::uint64_t samples = 0;
  double samples_per_pixel = 0;
  double seconds = 0;  ///< since the start
  double predicted_error =
      -1;  ///< root mean square, levels of 255 as shown; below 0: not yet known
  View view;
  bool finished = false;  ///< sampling has ended, and these are finished pixels
};

/// An error, in levels of 255, that is white in `Revision::error`.
inline constexpr double white_error = 16;

}  // namespace live
