// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/edge_spectrum.h"
#include "freqsynth/refine/least_squares_refiner.h"

namespace freqsynth {
namespace detail {

/// Normal equations of the samples of a block that are not gaps.
class GapSolver {
 public:
  explicit GapSolver(std::size_t terms)
      : terms_(terms), matrix_(terms * terms), side_(terms), change_(terms) {}

  void add(const SampleRow& row) {
    double a[max_terms];
    for (std::size_t i = 0; i < terms_; ++i) {
      a[i] = double{row.term(i)};
      for (std::size_t k = 0; k <= i; ++k) matrix_[i * terms_ + k] += a[i] * a[k];
    }
  }
  void take_off(const SampleRow& row, double off) {
    for (std::size_t i = 0; i < terms_; ++i) side_[i] -= double{row.term(i)} * off;
  }

  /// Finds the changes of the amplitudes.
  /// \return by how much the sum of squared residuals grows
  double solve(const float* amplitudes);
  [[nodiscard]] double change(std::size_t term) const { return change_[term]; }

 private:
  [[nodiscard]] double entry(std::size_t i, std::size_t k) const {
    return i >= k ? matrix_[i * terms_ + k] : matrix_[k * terms_ + i];
  }

  std::size_t terms_;
  std::vector<double> matrix_;  // the lower triangle
  std::vector<double> side_, change_;
};

inline double GapSolver::solve(const float* amplitudes) {
  // What is left may be too uneven to tell all terms apart. So each has a prior: that the energy of
  // the terms, and that of what comes after them, which is noise here, fall as those of edges do.
  // It counts for a third, for of most blocks the samples know more.
  constexpr double share = 0.3;
  const EdgeSpectrum& expected = edge_spectrum();
  const double noise = expected.tail[std::min(terms_, max_terms - 1)];
  std::vector<double> factor(terms_ * terms_);  // Cholesky's
  for (std::size_t i = 0; i < terms_; ++i) {
    const Frequency f = frequency_of_term(i);
    const double mean_square = (f.u > 0 ? 0.5 : 1) * (f.v > 0 ? 0.5 : 1);
    const double prior = i > 0 ? share * mean_square * noise / expected.energy[i] : 0;
    change_[i] = side_[i] - prior * double{amplitudes[i]};
    for (std::size_t k = 0; k <= i; ++k) {
      double sum = entry(i, k) + (i == k ? prior : 0);
      for (std::size_t m = 0; m < k; ++m) sum -= factor[i * terms_ + m] * factor[k * terms_ + m];
      factor[i * terms_ + k] = i == k ? std::sqrt(sum) : sum / factor[k * terms_ + k];
    }
  }
  for (std::size_t i = 0; i < terms_; ++i) {
    for (std::size_t k = 0; k < i; ++k) change_[i] -= factor[i * terms_ + k] * change_[k];
    change_[i] /= factor[i * terms_ + i];
  }
  for (std::size_t i = terms_; i-- > 0;) {
    for (std::size_t k = i + 1; k < terms_; ++k) change_[i] -= factor[k * terms_ + i] * change_[k];
    change_[i] /= factor[i * terms_ + i];
  }
  double growth = 0;
  for (std::size_t i = 0; i < terms_; ++i) {
    double product = 0;
    for (std::size_t k = 0; k < terms_; ++k) product += entry(i, k) * change_[k];
    growth += change_[i] * (product - 2 * side_[i]);
  }
  return growth;
}

}  // namespace detail

FREQSYNTH_INLINE LeastSquaresRefiner::LeastSquaresRefiner(SharedInverseList list,
                                                          std::size_t channels,
                                                          std::vector<float> weights)
    : owner_(std::move(list)), channels_(channels), weights_(std::move(weights)) {
  if (!owner_) detail::refuse("there is no inverse list");
  list_ = &*owner_;
  if (channels_ == 0) detail::refuse("channels is 0");
  if (weights_.empty()) weights_.assign(channels_, 1 / static_cast<float>(channels_));
  if (weights_.size() != channels_) {
    detail::refuse("weights has " + std::to_string(weights_.size()) + " entries for " +
                   std::to_string(channels_) + " channels");
  }
  for (const float weight : weights_) {
    detail::require(detail::is_finite(weight) && weight >= 0 && weight <= 1e6f, "one of weights",
                    weight, "in 0..1e6");
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
  const auto scale = [exponent](float* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values[i] = std::ldexp(values[i], exponent);
  };
  scale(state + channel * max_terms, max_terms);
  scale(state + (channels_ + 2 * channel) * max_terms, 2 * max_terms);
  float* squares = state + 3 * channels_ * max_terms + 2 * channel;
  squares[0] = std::ldexp(squares[0], 2 * exponent);
  squares[1] = std::ldexp(squares[1], exponent);
}

FREQSYNTH_INLINE float LeastSquaresRefiner::absorb_channelwise(float* state, std::size_t index,
                                                               const float* values) const {
  float change = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    float* own = state + c * max_terms;
    float* sums = state + (channels_ + 2 * c) * max_terms;
    const bool usable = is_usable_sample(values[c]);
    if (!detail::is_nan(own[0])) {
      float own_change = 0;
      detail::absorb_samples(&list_->row(index), 1, own, sums,
                             state + 3 * channels_ * max_terms + 2 * c,
                             usable ? values + c : nullptr, weights_.data() + c, 1, &own_change);
      change += own_change;
    } else if (usable) {
      start(own, sums, index, values[c]);
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
    for (std::size_t i = terms; i < max_terms; ++i) state[i] += value * (row.term(i));
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      sums[row.pixels[p]] += value * row.pixel_weights[p];
    }
    if (row.own_pixel != detail::SampleRow::no_pixel) sums[max_terms + row.own_pixel] += value;
  }
}

FREQSYNTH_INLINE void LeastSquaresRefiner::coefficients(const float* state, std::size_t samples,
                                                        std::size_t channel,
                                                        std::span<float, max_terms> out) const {
  const float* own = state + channel * max_terms;
  const bool known = samples > 0 && !detail::is_nan(own[0]);
  const std::size_t fit = known ? terms(samples) : 0;
  for (std::size_t i = 0; i < fit; ++i) out[i] = own[i] / detail::coefficient_amplitudes[i];
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(fit), out.end(), 0.0f);
}

FREQSYNTH_INLINE float LeastSquaresRefiner::prediction(const float* state, std::size_t index,
                                                       std::size_t channel) const {
  const float* own = state + channel * max_terms;
  const detail::SampleRow& row = list_->row(index);
  float sum = own[0];  // the first term is 1; not a number is not
  for (std::size_t i = 1; i < row.terms; ++i) sum += row.fit[i] * own[i];
  return sum;
}

FREQSYNTH_INLINE BlockFit LeastSquaresRefiner::fit(const float* state, std::size_t samples,
                                                   std::size_t channel,
                                                   std::span<const Gap> gaps) const {
  BlockFit fit = this->fit(state, samples, channel);
  fit.gaps = gaps;
  if (gaps.empty() || gaps.size() >= samples) return fit;
  // From the amplitudes X of the fit with the gaps to X + d without them: J d = r, where J and the
  // right-hand side r = -sum A e are those of the other samples, e what the gaps' values are off
  // the fit.
  const float* own = state + channel * max_terms;
  const std::size_t all = terms(samples);
  detail::GapSolver solver(all);
  std::vector<bool> gap(samples);
  for (const Gap& one : gaps) gap[one.sample] = true;
  double squares = double{squared_residuals(state, channel)};
  for (const Gap& one : gaps) {
    double off = double{one.value};
    const detail::SampleRow& row = list_->row(one.sample);
    for (std::size_t i = 0; i < all; ++i) off -= double{row.term(i)} * double{own[i]};
    solver.take_off(row, off);
    squares -= off * off;
  }
  for (std::size_t j = 0; j < samples; ++j) {
    if (!gap[j]) solver.add(list_->row(j));
  }
  squares += solver.solve(own);
  for (std::size_t i = 0; i < max_terms; ++i) {
    const double amplitude = i < all ? double{own[i]} + solver.change(i) : 0;
    fit.coefficients[i] = static_cast<float>(amplitude / amplitude_of_coefficient(i));
  }
  fit.residual = static_cast<float>(std::max(squares, 0.0)) / freedom(samples - gaps.size());
  return fit;
}

FREQSYNTH_INLINE BlockFit LeastSquaresRefiner::fit(const float* state, std::size_t samples,
                                                   std::size_t channel) const {
  BlockFit fit{.coefficients = {},
               .pixel_sums = pixel_sums(state, channel),
               .residual = residual(state, samples, channel),
               .gaps = {},
               .own_sums = own_sums(state, channel),
               .spread = spread(state, channel)};
  coefficients(state, samples, channel, fit.coefficients);
  return fit;
}

}  // namespace freqsynth
