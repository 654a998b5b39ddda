// SPDX-License-Identifier: MIT
/// \file
/// A post-filter that discards outliers.
#pragma once

#include "rendering.h"

namespace baselines {

struct AlphaTrimmedSettings {
  /// Share, in [0, 0.5), of the largest values that is discarded, and of the smallest.
  double alpha = 0.3;
  /// Distance of the hexagon's corners from the pixel, in pixels, > 0.
  double distance = 0.5;
};

/// Lee and Redner, A Note on the Use of Nonlinear Filtering in Computer Graphics, 1990: each pixel
/// becomes the mean of seven values, its own and those at the corners of a hexagon around it
/// (bilinear interpolation of the four nearest pixels; the border continues outside), without the
/// largest and smallest, component by component. Spikes vanish, and their energy with them.
[[nodiscard]] Rendering alpha_trimmed(const Rendering& rendering,
                                      const AlphaTrimmedSettings& settings = {});

}  // namespace baselines
