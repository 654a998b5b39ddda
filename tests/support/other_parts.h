// SPDX-License-Identifier: MIT
// An estimator and a measure of other kinds than the library's: what the engine demands of its
// parts, and no more.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/block_view.h"
#include "freqsynth/refine/refiner.h"

namespace helpers {

using freqsynth::BlockFit;
using freqsynth::BlockView;
using freqsynth::InverseList;
using freqsynth::is_usable_sample;
using freqsynth::max_terms;
using freqsynth::Refiner;
using freqsynth::SharedInverseList;

/// A block is the mean of its samples, and the residual is their variance.
class MeanRefiner {
 public:
  MeanRefiner(SharedInverseList list, std::size_t channels)
      : list_(std::move(list)), weights_(channels, 1 / static_cast<float>(channels)) {}

  [[nodiscard]] const InverseList& list() const { return *list_; }
  [[nodiscard]] std::size_t channels() const { return weights_.size(); }
  [[nodiscard]] std::span<const float> weights() const { return weights_; }

  /// 64 sums of pixels per channel, then per channel the mean, the sum of squared distances to it,
  /// and the number of usable values.
  [[nodiscard]] std::size_t state_size() const { return channels() * (max_terms + 3); }
  void reset(float* state) const { std::fill_n(state, state_size(), 0.0f); }
  void weigh(std::span<const float> weights) { weights_.assign(weights.begin(), weights.end()); }
  void rescale(float* state, std::size_t channel, int exponent) const {
    for (std::size_t i = 0; i < max_terms; ++i) {
      float& sum = state[channel * max_terms + i];
      sum = std::ldexp(sum, exponent);
    }
    float* own = state + channels() * max_terms + 3 * channel;
    own[0] = std::ldexp(own[0], exponent);
    own[1] = std::ldexp(own[1], 2 * exponent);
  }
  float absorb(float* state, std::size_t n, const float* values) const {
    float change = 0;
    for (std::size_t c = 0; c < channels(); ++c) {
      if (!is_usable_sample(values[c])) continue;
      float* own = state + channels() * max_terms + 3 * c;
      const float difference = values[c] - own[0];
      own[2] += 1;
      own[0] += difference / own[2];
      own[1] += difference * (values[c] - own[0]);
      if (own[2] > 1) change += weights_[c] * std::pow(difference / own[2], 2.0f);
      const freqsynth::detail::SampleRow& row = list_->row(n);
      for (std::size_t p = 0; p < row.pixel_count; ++p) {
        state[c * max_terms + row.pixels[p]] += values[c] * row.pixel_weights[p];
      }
    }
    return change;
  }
  void prefetch(const float*, std::size_t) const {}

  [[nodiscard]] float freedom(std::size_t n) const {
    return static_cast<float>(std::max<std::size_t>(n, 2) - 1);
  }
  [[nodiscard]] float residual(const float* state, std::size_t n) const {
    float sum = 0;
    for (std::size_t c = 0; c < channels(); ++c) sum += weights_[c] * residual(state, n, c);
    return sum;
  }
  [[nodiscard]] float residual(const float* state, std::size_t n, std::size_t channel) const {
    return state[channels() * max_terms + 3 * channel + 1] / freedom(n);
  }
  [[nodiscard]] std::size_t terms(std::size_t) const { return 1; }
  [[nodiscard]] std::span<const float, max_terms> variances(std::size_t) const { return ones; }

  void coefficients(const float* state, std::size_t, std::size_t channel,
                    std::span<float, max_terms> out) const {
    std::fill(out.begin(), out.end(), 0.0f);
    out[0] = 8 * state[channels() * max_terms + 3 * channel];
  }
  [[nodiscard]] BlockFit fit(const float* state, std::size_t n, std::size_t channel) const {
    BlockFit fit{{},
                 std::span<const float, max_terms>(state + channel * max_terms, max_terms),
                 residual(state, n, channel)};
    coefficients(state, n, channel, fit.coefficients);
    return fit;
  }

 private:
  static constexpr auto ones = [] {
    std::array<float, max_terms> values{};
    values.fill(1);
    return values;
  }();

  SharedInverseList list_;
  std::vector<float> weights_;
};

/// A measure of another kind: blocks with fewer samples first.
class FewestSamples {
 public:
  template <Refiner R>
  void use_units(const BlockView<R>&, float) {}
  template <Refiner R>
  [[nodiscard]] bool notice_noise(const BlockView<R>&) {
    return false;
  }
  template <Refiner R>
  void absorbed(const BlockView<R>&, std::uint32_t, std::span<const float>) {}
  [[nodiscard]] static bool apart() { return true; }
  template <Refiner R>
  double absorbed_apart(const BlockView<R>&, std::uint32_t, std::span<const float>) {
    return 0;
  }
  static void add(double) {}
  template <Refiner R>
  [[nodiscard]] float priority(const BlockView<R>& view, std::uint32_t block, float) const {
    return 1 / static_cast<float>(view.blocks.samples(block));
  }
  [[nodiscard]] bool has_news(std::uint32_t) { return false; }
  [[nodiscard]] bool cares(float) const { return false; }
  [[nodiscard]] static bool in_units() { return true; }
};

}  // namespace helpers
