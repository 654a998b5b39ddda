// SPDX-License-Identifier: MIT
/// \file
/// A post-filter that spreads outliers.
#pragma once

#include "rendering.h"

namespace baselines {

struct EnergyPreservingSettings {
  /// A pixel is noisy when it differs from the mean of its neighbours by more than this many of
  /// their standard deviations. >= 0.
  double deviations = 2;
  /// Most that a pixel may receive from a noisy one, relative to the mean of the picture: the
  /// authors' threshold of visibility, one of 256 levels when the mean is mapped to the middle. >
  /// 0.
  double visible = 1.0 / 128;
  /// Widest window to spread over: this many pixels to each side. >= 1.
  std::size_t reach = 16;
};

/// Rushmeier and Ward, Energy Preserving Non-Linear Filters, 1994: a noisy pixel keeps the mean of
/// its neighbours, and its excess (or lack) is spread evenly over a square window around it, just
/// so wide that no pixel receives more than is visible. What even the widest window cannot take
/// stays in the pixel. The mean of the picture does not change.
///
/// The variance of a pixel's own samples is not known here, so that noisy pixels are told by their
/// up to eight neighbours: by `deviations`, and by more than is visible.
[[nodiscard]] Rendering energy_preserving(const Rendering& rendering,
                                          const EnergyPreservingSettings& settings = {});

}  // namespace baselines
