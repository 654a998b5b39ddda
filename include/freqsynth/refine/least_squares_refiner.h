/// \file
/// The paper's block refiner (sections 4.1 and 4.2): least squares in the first T cosine terms.
///
/// A block's state is 64 floats per channel: the amplitudes X = G(u, v) (eq. 24) of the T terms in
/// the fit, and the right-hand sides Y (eq. 23) of the others; and then, for all channels, the sums
/// of squared residuals (eq. 11). With the shared gain k = J^-1 A a sample S changes X by k (S - A
/// . X), which is eq. 25 at O(T) instead of O(T^2).
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"

namespace freqsynth {

/// Largest magnitude that a block can absorb: squares of sums of many such values stay finite.
inline constexpr float max_sample_magnitude = 1e15f;

/// False for a value that is too large, infinite or not a number.
[[nodiscard]] inline bool is_usable_sample(float value) {
  return std::abs(value) <= max_sample_magnitude;
}

/// Refines the states of blocks; the states themselves belong to the caller.
class LeastSquaresRefiner {
 public:
  /// \param weights  weight of each channel in what absorb() returns; empty: 1 / channels
  /// \throws std::invalid_argument when the list is null, channels is 0, or the weights are not
  ///         `channels` finite numbers >= 0.
  LeastSquaresRefiner(std::shared_ptr<const InverseList> list, std::size_t channels,
                      std::vector<float> weights = {});

  [[nodiscard]] const InverseList& list() const { return *list_; }
  [[nodiscard]] std::size_t channels() const { return channels_; }
  /// Weight of each channel.
  [[nodiscard]] std::span<const float> weights() const { return weights_; }
  /// Floats in the state of a block. States are aligned to 32 bytes.
  [[nodiscard]] std::size_t state_size() const {
    return 2 * channels_ * max_terms + (channels_ + 15) / 16 * 16;
  }

  /// Puts a state to "no sample yet".
  void reset(float* state) const;

  /// Absorbs the values of sample `index` of the sequence; every index must come, in order.
  ///
  /// A value that is not usable is replaced by the block's own prediction, so that the sequence
  /// goes on and no information is added. Before a channel's first usable value there is no
  /// prediction; the earlier samples then count as equal to that first value.
  /// \return the mean squared change of the block's pixels (of its coefficients / 8), weighted over
  ///         the channels. The first usable value of a channel, with nothing to change, counts 0.
  float absorb(float* state, std::size_t index, const float* values) const;

  /// Writes the coefficients F (eq. 26, zig-zag) of a channel after `samples` samples; zeros when
  /// the channel had no usable value.
  void coefficients(const float* state, std::size_t samples, std::size_t channel,
                    std::span<float, max_terms> out) const;

  /// Sum of the squared differences (eq. 11) between the samples of a channel and their fit.
  [[nodiscard]] float squared_residuals(const float* state, std::size_t channel) const {
    return state[2 * channels_ * max_terms + channel];
  }

  /// Sums of a channel's samples in each of the 64 pixels of the block, row by row. A sample on the
  /// border between pixels counts half, or a quarter, for each.
  [[nodiscard]] std::span<const float, max_terms> pixel_sums(const float* state,
                                                             std::size_t channel) const {
    return std::span<const float, max_terms>(state + (channels_ + channel) * max_terms, max_terms);
  }

 private:
  float absorb_channelwise(float* state, std::size_t index, const float* values) const;
  void start(float* state, float* sums, std::size_t index, float value) const;

  std::shared_ptr<const InverseList> list_;
  std::size_t channels_;
  std::vector<float> weights_;
};

/// The paper's literal path for one channel: Y is summed up and X = J^-1 Y (eq. 25) solved anew,
/// O(T^2) a sample. It gives the same X as the refiner: the oracle of its tests and the competitor
/// of its benchmark.
class LiteralRefiner {
 public:
  explicit LiteralRefiner(std::shared_ptr<const InverseList> list) : list_(std::move(list)) {}

  /// Adds the next sample to Y (eq. 23) and solves for X (eq. 25).
  void absorb(double value);

  /// Amplitudes X of the terms in the fit.
  [[nodiscard]] std::span<const double> amplitudes() const { return {x_, terms_}; }

 private:
  std::shared_ptr<const InverseList> list_;
  std::size_t samples_ = 0, terms_ = 0;
  double x_[max_terms] = {};
  double y_[max_terms] = {};
};

// ------------------------------------------------------------------------------------ definitions

inline LeastSquaresRefiner::LeastSquaresRefiner(std::shared_ptr<const InverseList> list,
                                                std::size_t channels, std::vector<float> weights)
    : list_(std::move(list)), channels_(channels), weights_(std::move(weights)) {
  if (!list_) throw std::invalid_argument("freqsynth: the inverse list is null");
  if (channels_ == 0) throw std::invalid_argument("freqsynth: channels is 0");
  if (weights_.empty()) weights_.assign(channels_, 1 / static_cast<float>(channels_));
  if (weights_.size() != channels_) {
    throw std::invalid_argument("freqsynth: channel_weights has " +
                                std::to_string(weights_.size()) + " entries for " +
                                std::to_string(channels_) + " channels");
  }
  for (const float weight : weights_) {
    if (!(weight >= 0 && std::isfinite(weight))) {
      throw std::invalid_argument("freqsynth: channel_weights holds " + std::to_string(weight));
    }
  }
}

inline void LeastSquaresRefiner::reset(float* state) const {
  for (std::size_t i = 0; i < state_size(); ++i) state[i] = 0;
  // A constant term that is not a number marks a channel without a usable value.
  for (std::size_t c = 0; c < channels_; ++c) {
    state[c * max_terms] = std::numeric_limits<float>::quiet_NaN();
  }
}

inline float LeastSquaresRefiner::absorb(float* state, std::size_t index,
                                         const float* values) const {
  for (std::size_t c = 0; c < channels_; ++c) {
    if (std::isnan(state[c * max_terms]) || !is_usable_sample(values[c])) [[unlikely]] {
      return absorb_channelwise(state, index, values);
    }
  }
  return detail::absorb_sample(list_->row(index), state, state + channels_ * max_terms,
                               state + 2 * channels_ * max_terms, values, weights_.data(),
                               channels_);
}

inline float LeastSquaresRefiner::absorb_channelwise(float* state, std::size_t index,
                                                     const float* values) const {
  float change = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    float* own = state + c * max_terms;
    const bool usable = is_usable_sample(values[c]);
    if (!std::isnan(own[0])) {
      change += detail::absorb_sample(list_->row(index), own, own + channels_ * max_terms,
                                      state + 2 * channels_ * max_terms + c,
                                      usable ? values + c : nullptr, weights_.data() + c, 1);
    } else if (usable) {
      start(own, own + channels_ * max_terms, index, values[c]);
    }
  }
  return change;
}

inline void LeastSquaresRefiner::start(float* state, float* sums, std::size_t index,
                                       float value) const {
  // As if all samples up to this one had been equal to it: a constant, whose fit is exact.
  state[0] = value;
  const std::size_t terms = list_->terms(index);
  for (std::size_t j = 0; j <= index; ++j) {
    const detail::SampleRow& row = list_->row(j);
    for (std::size_t i = terms; i < max_terms; ++i) state[i] += value * (row.fit[i] + row.rest[i]);
    for (std::size_t p = 0; p < row.pixel_count; ++p)
      sums[row.pixels[p]] += value * row.pixel_weight;
  }
}

inline void LeastSquaresRefiner::coefficients(const float* state, std::size_t samples,
                                              std::size_t channel,
                                              std::span<float, max_terms> out) const {
  const float* own = state + channel * max_terms;
  const bool known = samples > 0 && !std::isnan(own[0]);
  const std::size_t terms = known ? list_->terms(samples - 1) : 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    out[i] = i < terms ? own[i] / static_cast<float>(amplitude_of_coefficient(i)) : 0;
  }
}

inline void LiteralRefiner::absorb(double value) {
  const SequencePosition& position = list_->position(samples_);
  double a[max_terms];
  evaluate_terms(position.s, position.t, a);
  for (std::size_t i = 0; i < max_terms; ++i) y_[i] += value * a[i];
  terms_ = list_->terms(samples_);
  const double* row = list_->inverse(samples_).data();
  for (std::size_t i = 0; i < terms_; ++i) {
    // One triangle serves both halves of the product.
    double sum = 0;
    for (std::size_t j = 0; j < i; ++j) {
      sum += row[j] * y_[j];
      x_[j] += row[j] * y_[i];
    }
    x_[i] = sum + row[i] * y_[i];
    row += i + 1;
  }
  ++samples_;
}

}  // namespace freqsynth
