// SPDX-License-Identifier: MIT
/// \file
/// Supersampling: the same rate everywhere.
#pragma once

#include "filter.h"
#include "rendering.h"

namespace baselines {

struct SupersamplingSettings {
  bool jittered = true;  ///< a random position in each stratum instead of its middle
  PixelFilter filter = PixelFilter::box;
};

/// One sample in each stratum of for_each_stratum(), on a regular grid or jittered (Cook,
/// Stochastic Sampling in Computer Graphics, 1986), and a weighted average, its filter widened by
/// width_for_rate(). A jittered box at a whole number of samples per pixel is the plain mean of the
/// samples in each pixel. Takes exactly the samples allowed.
[[nodiscard]] Rendering supersampling(const Radiance& radiance, const Job& job,
                                      const SupersamplingSettings& settings = {});

/// The samples alone, for other reconstructions.
[[nodiscard]] std::vector<Sample> supersamples(Sampler& sampler, const Job& job, bool jittered);

}  // namespace baselines
