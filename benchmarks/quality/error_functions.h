// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "freqsynth/engine/thread_pool.h"

namespace quality {

/// Predicted over true RMSE of so many random functions of the field cases, whose averages are
/// exact, as they are and with noise: a Markdown table with a row for each rate. One run of each.
[[nodiscard]] std::string random_functions_table(std::size_t functions,
                                                 freqsynth::ThreadPool& pool);

}  // namespace quality
