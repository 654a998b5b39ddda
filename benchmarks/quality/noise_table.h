// SPDX-License-Identifier: MIT
/// \file
/// How pictures of noisy scenes compare, to read at once.
#pragma once

#include <span>
#include <string>

#include "quality/results.h"

namespace quality {

/// A line for each result in the order of scenes, rates and methods as they first appear, with what
/// denoisers are compared by. The reference's own error is taken out of the RMSE: its square off
/// the square. Below, for each rate and method, over all scenes: the geometric mean of RMSE
/// relative to that of the first method, the means of relMSE and SSIM, and the worst of the others.
[[nodiscard]] std::string noise_table(std::span<const Result> results);

}  // namespace quality
