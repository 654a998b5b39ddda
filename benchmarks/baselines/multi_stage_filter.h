// SPDX-License-Identifier: MIT
/// \file
/// A reconstruction that does not mind clumps of samples.
#pragma once

#include <span>

#include "sampler.h"

namespace baselines {

/// Mitchell, Generating Antialiased Images at Low Sampling Densities, 1987: box filters of growing
/// width, each averaging the output of the one before, so that a dense clump of samples weighs as
/// much as a sparse one. The widths are 1/4, 1/2 and 1 pixel; each stage gives values one filter
/// width apart, and those that found nothing do not take part in the next.
///
/// Pixels that are empty after that take the mean of the values of the pixels that are not, in the
/// smallest window of 3 x 3, 5 x 5, 9 x 9, ... pixels that contains one. There must be at least one
/// sample.
void multi_stage_filter(std::span<const Sample> samples, Rendering& rendering);

}  // namespace baselines
