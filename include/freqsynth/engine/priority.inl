// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/engine/priority.h"

namespace freqsynth {

namespace detail {

/// What a sample is worth by the number of samples before it, for residuals of 1; see
/// PrioritySettings.
inline std::vector<float> gains_of_samples(std::size_t max_samples) {
  std::vector<float> gains(max_samples + 1, static_cast<float>(max_terms));
  std::size_t step = 0;
  for (std::size_t n = 1; n <= max_samples; ++step) {
    const auto before = static_cast<double>(SampleSequence::even_size(step));
    const std::size_t end = SampleSequence::even_size(step + 1);
    const auto after = static_cast<double>(end);
    const double share = (1 - std::pow(before / after, 1.5)) / (after - before);
    for (; n < end && n <= max_samples; ++n) {
      gains[n] = static_cast<float>(double{max_terms} * share / static_cast<double>(n));
    }
  }
  return gains;
}

}  // namespace detail

FREQSYNTH_INLINE void PrioritySettings::validate() const {
  // The ends of the ranges keep products with variances within what a float can say.
  constexpr double most = 1e6;
  const auto up_to_most = [](double value, const char* name) {
    detail::require(detail::is_finite(value) && value >= 0 && value <= most, name, value,
                    "in 0..1e6");
  };
  detail::require(detail::is_finite(weight) && weight > 0 && weight <= 1, "priority.weight", weight,
                  "in (0, 1]");
  up_to_most(uncertainty, "priority.uncertainty");
  up_to_most(neighbours, "priority.neighbours");
  up_to_most(image, "priority.image");
  detail::require(detail::is_finite(exploration) && exploration >= 0 && exploration <= 1,
                  "priority.exploration", exploration, "in [0, 1]");
  detail::require(steer <= Steer::display, "priority.steer", static_cast<double>(steer),
                  "linear, relative or display");
  detail::require(detail::is_finite(exposure) && exposure >= 1e-30 && exposure <= 1e30,
                  "priority.exposure", exposure, "in 1e-30..1e30");
  detail::require(detail::is_finite(decay) && decay >= 0 && decay < 1, "priority.decay", decay,
                  "in [0, 1)");
}

FREQSYNTH_INLINE PriorityMetric::PriorityMetric(const PrioritySettings& settings,
                                                std::size_t max_samples)
    : weight_(static_cast<float>(settings.weight)),
      doubts_(max_samples + 1),
      gains_(detail::gains_of_samples(max_samples)),
      uncertainty_(max_samples + 1) {
  settings.validate();
  double running = settings.uncertainty;
  double term = settings.uncertainty;
  for (std::size_t n = 0; n <= max_samples; ++n) {
    doubts_[n] = static_cast<float>(n == 0 ? term : term / static_cast<double>(n));
    running += settings.weight * (term - running);
    term *= settings.decay;
    uncertainty_[n] = static_cast<float>(running) + floor(n);
  }
}

}  // namespace freqsynth
