// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/jpeg/quantization_target.h"

namespace freqsynth {

FREQSYNTH_INLINE void QuantizationTarget::validate(std::size_t channels) const {
  if (steps.size() != channels) {
    detail::refuse("the quantization target has steps for " + std::to_string(steps.size()) +
                   " of " + std::to_string(channels) + " channels");
  }
  for (const auto& channel : steps) {
    for (const float step : channel) {
      detail::require(!detail::is_nan(step) && step >= 1e-37f, "a quantization target's step", step,
                      "at least 1e-37");
    }
  }
  if (most_samples == 0) detail::refuse("the quantization target's most_samples is 0");
  detail::require(detail::is_finite(tolerance) && tolerance > 0,
                  "the quantization target's tolerance", tolerance, "a finite number > 0");
}

FREQSYNTH_INLINE float evenness(std::size_t samples) {
  constexpr std::size_t pixels = block_size * block_size;
  return samples <= pixels ? 1
                           : std::sqrt(static_cast<float>(pixels) / static_cast<float>(samples));
}

FREQSYNTH_INLINE float quantized_error(const std::array<float, max_terms>& steps,
                                       std::span<const float, max_terms> coefficients,
                                       std::span<const float, max_terms> variances,
                                       float residual) {
  float sum = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    const float variance = residual * variances[i] / (steps[i] * steps[i]);
    const float magnitude = std::abs(coefficients[i]) / steps[i];
    const float margin = 0.5f - magnitude;  // to the nearest value that is not quantised to 0
    const bool stays_zero = i > 0 && margin > 0 && margin * margin > 4 * variance;
    sum += stays_zero ? 0 : variance;
  }
  return sum;
}

}  // namespace freqsynth
