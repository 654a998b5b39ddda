// SPDX-License-Identifier: MIT
/// \file
/// Adaptive subdivision of pixels by their corners.
#pragma once

#include "rendering.h"

namespace baselines {

struct WhittedSettings {
  /// Share of the samples, in (0, 1], that the corners of the undivided squares may take.
  double base_share = 0.5;
  /// Radiance above which differences do not count, because a display does not show them. > 0.
  float white = 1;
};

/// Whitted, An Improved Illumination Model for Shaded Display, 1980: samples at the corners of
/// squares, shared by neighbours; squares whose corners differ are divided into four.
///
/// Whitted divides down to a threshold. Here it is lowered until the samples are spent: the square
/// that counts most, by the contrast of its corners (largest difference of any component) times its
/// area, is divided first, and among equals the largest. The squares to begin with are the smallest
/// of 1/16, ..., 1/2, 1, 2, 4, ... pixels that base_share pays for. The radiance in a square that
/// is not divided is the bilinear interpolation of its corners, integrated exactly over each pixel,
/// which for a part of a pixel is Whitted's mean of the four corners, weighted by area.
///
/// Up to 4 samples may be left, because a division takes up to 5. Fewer than 4 samples in all are
/// averaged.
[[nodiscard]] Rendering whitted(const Radiance& radiance, const Job& job,
                                const WhittedSettings& settings = {});

}  // namespace baselines
