// SPDX-License-Identifier: MIT
/// \file
/// An estimator without any estimating: what it says of a block is what it was told, so that the
/// parts that look at estimates can be tested with estimates of the test's choice.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/refine/refiner.h"
#include "support/refiner_helpers.h"

namespace helpers {

/// The residual of a channel is the last value that it absorbed.
class ScriptedRefiner {
 public:
  /// \param weights  one per channel
  explicit ScriptedRefiner(std::vector<float> weights)
      : weights_(std::move(weights)), variances_(most) {
    for (std::size_t n = 0; n < most; ++n) {
      for (std::size_t i = 0; i < max_terms; ++i) {
        variances_[n][i] = (1 + static_cast<float>(i % 7)) / static_cast<float>(n + 1);
      }
    }
  }

  [[nodiscard]] const InverseList& list() const { return *list_; }
  [[nodiscard]] std::size_t channels() const { return weights_.size(); }
  void weigh(std::span<const float> weights) { weights_.assign(weights.begin(), weights.end()); }
  /// What it is told are residuals, squares.
  void rescale(float* state, std::size_t channel, int exponent) const {
    state[channel] = std::ldexp(state[channel], 2 * exponent);
  }
  [[nodiscard]] std::span<const float> weights() const { return weights_; }
  /// The values, and the number of samples; no whole number of cache lines.
  [[nodiscard]] std::size_t state_size() const { return channels() + 1; }

  void reset(float* state) const {
    expect_aligned(state);
    std::fill_n(state, state_size(), 0.0f);
  }
  /// \return the value of the first channel
  float absorb(float* state, std::size_t n, const float* values) const {
    expect_aligned(state);
    EXPECT_EQ(state[channels()], static_cast<float>(n)) << "every sample comes once, in order";
    ++state[channels()];
    std::copy_n(values, channels(), state);
    return values[0];
  }
  void prefetch(const float*, std::size_t) const {}

  [[nodiscard]] float freedom(std::size_t n) const { return 1 + 0.75f * static_cast<float>(n); }
  [[nodiscard]] float residual(const float* state, std::size_t n) const {
    float sum = 0;
    for (std::size_t c = 0; c < channels(); ++c) sum += weights_[c] * residual(state, n, c);
    return sum;
  }
  [[nodiscard]] float residual(const float* state, std::size_t, std::size_t channel) const {
    return state[channel];
  }
  [[nodiscard]] std::size_t terms(std::size_t n) const { return std::min(n, max_terms); }
  [[nodiscard]] std::span<const float, max_terms> variances(std::size_t n) const {
    return variances_[n % most];
  }

  void coefficients(const float* state, std::size_t n, std::size_t channel,
                    std::span<float, max_terms> out) const {
    for (std::size_t i = 0; i < max_terms; ++i) {
      const auto phase = static_cast<float>(i + 7 * channel + 3 * n);
      out[i] = 2 * std::sqrt(state[channel]) * std::sin(phase);
    }
  }
  [[nodiscard]] freqsynth::BlockFit fit(const float* state, std::size_t n,
                                        std::size_t channel) const {
    freqsynth::BlockFit fit{{}, zeros, residual(state, n, channel)};
    coefficients(state, n, channel, fit.coefficients);
    return fit;
  }

 private:
  static constexpr std::size_t most = 400;
  static constexpr std::array<float, max_terms> zeros{};

  static void expect_aligned(const float* state) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(state) % 64, 0u) << "a block starts a cache line";
  }

  std::vector<float> weights_;
  std::vector<std::array<float, max_terms>> variances_;
  SharedInverseList list_ = shared_list();
};

static_assert(freqsynth::Refiner<ScriptedRefiner>);

}  // namespace helpers
