// SPDX-License-Identifier: MIT
/// \file
/// Samplers that are slow, or that fail, for trials.
#pragma once

#include <cstdint>
#include <optional>

#include "tracing.h"

namespace farm {

/// What a sampler suffers from.
struct TrialSettings {
  double busy_microseconds = 0;   ///< CPU time of each sample, beside its own
  double sleep_microseconds = 0;  ///< of each sample
  bool uneven = false;            ///< on rank r, r times as long
  std::optional<std::uint64_t> delays;
  double failures = 0;  ///< probability that a call throws
};

/// The sampler with these sufferings, on a rank.
[[nodiscard]] SampleFunction on_trial(SampleFunction sample, const TrialSettings& settings,
                                      int rank);

}  // namespace farm
