// SPDX-License-Identifier: MIT
/// \file
/// A weighted average whose width follows the noise.
#pragma once

#include <vector>

#include "filter.h"
#include "rendering.h"

namespace baselines {

struct DippeWoldSettings {
  PixelFilter filter = PixelFilter::tent;
  /// Widths to choose from, relative to the filter's own, growing, at least one.
  std::vector<double> widths = {0.75, 1.5, 3};
  /// Signal to noise ratio (of powers) below which a wider filter is taken. >= 0; 0 never widens.
  /// The noise of jittered samples at an edge is overestimated, so that 1 would blur edges; pure
  /// noise asks for 2.
  double threshold = 0.5;
};

/// Dippe and Wold, Antialiasing Through Stochastic Sampling, 1985: jittered samples and a filter
/// whose width adapts to the local signal to noise ratio. Where noise drowns the signal it is wide;
/// where there is a signal to lose it is not.
///
/// Signal is what the next wider filter would take away: the squared difference of the two averages
/// (their measure of error, the difference between reconstructions). Noise is the variance of the
/// average of independent samples with the variance found under the narrowest filter that holds at
/// least four. Beginning with the narrowest, each pixel takes the next width while signal / noise
/// is below the threshold. Below one sample per pixel all widths grow by width_for_rate(). Takes
/// exactly the samples allowed.
[[nodiscard]] Rendering dippe_wold(const Radiance& radiance, const Job& job,
                                   const DippeWoldSettings& settings = {});

/// The widths alone that dippe_wold() chooses for each pixel, from samples of an image of this
/// size.
[[nodiscard]] std::vector<float> dippe_wold_widths(std::span<const Sample> samples,
                                                   std::size_t width, std::size_t height,
                                                   const DippeWoldSettings& settings);

}  // namespace baselines
