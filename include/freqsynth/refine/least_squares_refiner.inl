// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/refine/least_squares_refiner.h"

namespace freqsynth {

FREQSYNTH_INLINE LeastSquaresRefiner::LeastSquaresRefiner(SharedInverseList list,
                                                          std::size_t channels,
                                                          std::vector<float> weights)
    : owner_(std::move(list)), channels_(channels), weights_(std::move(weights)) {
  if (!owner_) detail::refuse("there is no inverse list");
  list_ = &*owner_;
  if (channels_ == 0) detail::refuse("channels is 0");
  if (weights_.empty()) weights_.assign(channels_, 1 / static_cast<float>(channels_));
  if (weights_.size() != channels_) {
    detail::refuse("channel_weights has " + std::to_string(weights_.size()) + " entries for " +
                   std::to_string(channels_) + " channels");
  }
  for (const float weight : weights_) {
    detail::require(detail::is_finite(weight) && weight >= 0 && weight <= 1e6f,
                    "one of channel_weights", weight, "in 0..1e6");
  }
}

FREQSYNTH_INLINE void LeastSquaresRefiner::reset(float* state) const {
  std::fill_n(state, state_size(), 0.0f);
  // A constant term that is not a number marks a channel without a usable value.
  for (std::size_t c = 0; c < channels_; ++c) {
    state[c * max_terms] = std::bit_cast<float>(0x7fc00000u);
  }
}

FREQSYNTH_INLINE void LeastSquaresRefiner::rescale(float* state, std::size_t channel,
                                                   int exponent) const {
  float* own = state + channel * max_terms;
  float* sums = own + channels_ * max_terms;
  for (std::size_t i = 0; i < max_terms; ++i) {
    own[i] = std::ldexp(own[i], exponent);
    sums[i] = std::ldexp(sums[i], exponent);
  }
  float& squares = state[2 * channels_ * max_terms + channel];
  squares = std::ldexp(squares, 2 * exponent);
}

FREQSYNTH_INLINE float LeastSquaresRefiner::absorb_channelwise(float* state, std::size_t index,
                                                               const float* values) const {
  float change = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    float* own = state + c * max_terms;
    const bool usable = is_usable_sample(values[c]);
    if (!detail::is_nan(own[0])) {
      change += detail::absorb_sample(list_->row(index), own, own + channels_ * max_terms,
                                      state + 2 * channels_ * max_terms + c,
                                      usable ? values + c : nullptr, weights_.data() + c, 1);
    } else if (usable) {
      start(own, own + channels_ * max_terms, index, values[c]);
    }
  }
  return change;
}

FREQSYNTH_INLINE void LeastSquaresRefiner::start(float* state, float* sums, std::size_t index,
                                                 float value) const {
  // As if all samples up to this one had been equal to it: a constant, whose fit is exact.
  state[0] = value;
  const std::size_t terms = list_->terms(index);
  for (std::size_t j = 0; j <= index; ++j) {
    const detail::SampleRow& row = list_->row(j);
    for (std::size_t i = terms; i < max_terms; ++i) state[i] += value * (row.fit[i] + row.rest[i]);
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      sums[row.pixels[p]] += value * row.pixel_weight;
    }
  }
}

FREQSYNTH_INLINE void LeastSquaresRefiner::coefficients(const float* state, std::size_t samples,
                                                        std::size_t channel,
                                                        std::span<float, max_terms> out) const {
  const float* own = state + channel * max_terms;
  const bool known = samples > 0 && !detail::is_nan(own[0]);
  const std::size_t fit = known ? terms(samples) : 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    out[i] = i < fit ? own[i] / static_cast<float>(amplitude_of_coefficient(i)) : 0;
  }
}

FREQSYNTH_INLINE BlockFit LeastSquaresRefiner::fit(const float* state, std::size_t samples,
                                                   std::size_t channel) const {
  BlockFit fit{{}, pixel_sums(state, channel), residual(state, samples, channel)};
  coefficients(state, samples, channel, fit.coefficients);
  return fit;
}

}  // namespace freqsynth
