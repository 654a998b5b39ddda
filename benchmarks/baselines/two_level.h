// SPDX-License-Identifier: MIT
/// \file
/// Adaptive sampling with two densities.
#pragma once

#include <vector>

#include "filter.h"
#include "rendering.h"

namespace baselines {

struct TwoLevelSettings {
  /// Share of the samples, in (0, 1], for the base density.
  double base_share = 0.25;
  /// Contrasts of red, green and blue from which on a cell counts as high (Mitchell's). > 0.
  Rgb contrast = {0.4f, 0.3f, 0.6f};
  /// A contrast is judged by at least this many samples (Mitchell: eight or nine): those of the
  /// cell itself, or if they are fewer those of the 3 x 3 cells around it.
  std::uint32_t judged = 8;
  /// Most extra samples of a cell, for each base sample in it. >= 1.
  double most_extra = 16;
  /// Multi-stage instead of weighted average.
  bool multi_stage = false;
  /// Of the weighted average.
  PixelFilter filter = PixelFilter::box;
};

/// Contrast of a set of samples, (max - min) / (max + min) of each component, 0 where all are 0.
[[nodiscard]] Rgb contrast(const Rgb& low, const Rgb& high);

/// Cook, Stochastic Sampling in Computer Graphics, 1986, and Mitchell, Generating Antialiased
/// Images at Low Sampling Densities, 1987: a base density everywhere; cells of high contrast are
/// sampled again, more densely.
///
/// Cells are pixels with the same whole number of base samples, or below one base sample per pixel
/// larger, with one base sample each. All samples are stratified in their cell and jittered. The
/// extra samples are shared equally by the cells with a contrast above the threshold, at most
/// `most_extra` for a base sample. If that does not spend them, which it never does in a picture
/// without contrast, the threshold is lowered until it does. Takes exactly the samples allowed.
///
/// The weighted average is widened by width_for_rate() of each pixel's own cell.
[[nodiscard]] Rendering two_level(const Radiance& radiance, const Job& job,
                                  const TwoLevelSettings& settings = {});

}  // namespace baselines
