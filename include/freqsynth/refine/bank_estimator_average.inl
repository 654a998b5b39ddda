// SPDX-License-Identifier: MIT
// The averages of a BankEstimator, from the evidence of its members.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/rounding.h"

namespace freqsynth {

/// Log posteriors to posteriors, without those that do not count.
FREQSYNTH_ROUNDING inline void BankEstimator::choose() {
  FREQSYNTH_ROUNDING_BEGIN
  constexpr double least = 0.001;
  const std::size_t members = lists_.size();
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const std::span<double> own(evidence_.data() + node * members, members);
    const double best = *std::max_element(own.begin(), own.end());
    double sum = 0;
    for (std::size_t k = 0; k < members; ++k) {
      if (float* out = nodes_[node]->posterior) out[k] = static_cast<float>(own[k] - best);
      own[k] = detail::exp_minus(best - own[k]);
      if (own[k] < least) own[k] = 0;
      sum += own[k];
    }
    for (double& weight : own) weight /= sum;
  }
}

/// Adds a member's averages, and their squares to the errors.
FREQSYNTH_ROUNDING inline void BankEstimator::average(std::size_t member) {
  FREQSYNTH_ROUNDING_BEGIN
  const std::size_t members = lists_.size(), averages = lists_.grid().count();
  some_.clear();
  for (const std::uint32_t node : all_) {
    if (evidence_[node * members + member] > 0) some_.push_back(node);
  }
  if (some_.empty()) return;
  innovate(lists_[member], some_, lists_.max_samples(), true,
           [&](std::size_t node, std::size_t channel, float, std::size_t lane) {
             const double weight = evidence_[node * members + member];
             double* out = averages_.data() + (node * channels_ + channel) * averages;
             double* errors = errors_.data() + node * averages;
             for (std::size_t p = 0; p < averages; ++p) {
               const double value = double{sums_[p * detail::lane_count + lane]};
               out[p] += weight * value;
               errors[p] += weight * (value * value);
             }
           });
  add_variances(member);
}

/// The square of the scale that a member sees in a node now: the mean square of the later
/// innovations, which tell how well it foresees what it has not seen, and one more that is as all
/// are in the mean. The earlier ones tell of the whole course of a function, whose detail may be
/// far smoother than the prior's, or rougher.
FREQSYNTH_ROUNDING inline double BankEstimator::scale_of(std::size_t node,
                                                         std::size_t member) const {
  FREQSYNTH_ROUNDING_BEGIN
  const std::size_t count = nodes_[node]->count;
  const double mean = squares_[node * lists_.size() + member] /
                      static_cast<double>(std::max<std::size_t>(1, count - 1));
  return (later_[node] + mean) / static_cast<double>(count - detail::later_half(count) + 1);
}

/// Adds what a member expects of its own errors.
FREQSYNTH_ROUNDING inline void BankEstimator::add_variances(std::size_t member) {
  FREQSYNTH_ROUNDING_BEGIN
  const std::size_t members = lists_.size(), averages = lists_.grid().count();
  const InnovationList& list = lists_[member];
  std::vector<double> variances(list.first_variances().begin(), list.first_variances().end());
  std::size_t row = 1;
  // Those with the fewest samples first.
  for (std::size_t i = some_.size(); i-- > 0;) {
    const std::size_t node = some_[i], count = nodes_[node]->count;
    for (; row < count; ++row) {
      const float* gains = list.row(row).gains.data();
      for (std::size_t p = 0; p < averages; ++p) {
        variances[p] -= double{gains[p]} * double{gains[p]};
      }
    }
    const double weight = evidence_[node * members + member];
    const double scale = scale_of(node, member);
    // Below it, variances are rounding.
    constexpr double least = 1e-12;
    double mean = 0;
    for (std::size_t p = 0; p < averages; ++p) {
      if (inside_[p]) mean += std::max(variances[p], least);
    }
    mean /= inside_count_;
    double* errors = errors_.data() + node * averages;
    double* doubts = doubts_.data() + node * averages;
    for (std::size_t p = 0; p < averages; ++p) {
      errors[p] += weight * scale * std::max(variances[p], 0.0);
      doubts[p] += weight * (std::max(variances[p], least) / mean);
    }
  }
}

FREQSYNTH_ROUNDING inline void BankEstimator::store() {
  FREQSYNTH_ROUNDING_BEGIN
  const std::size_t averages = lists_.grid().count();
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    double* errors = errors_.data() + node * averages;
    for (std::size_t c = 0; c < channels_; ++c) {
      const std::size_t lane = node * channels_ + c;
      const double* mean = averages_.data() + lane * averages;
      float* out = nodes_[node]->averages + c * averages;
      for (std::size_t p = 0; p < averages; ++p) {
        // How far members are apart is the mean of their squares less the square of their mean.
        errors[p] -= mean[p] * mean[p];
        out[p] = static_cast<float>(double{bases_[lane]} + mean[p]);
      }
    }
    if (float* out = nodes_[node]->squared_errors) {
      for (std::size_t p = 0; p < averages; ++p) {
        out[p] = static_cast<float>(std::max(errors[p], 0.0) / static_cast<double>(channels_));
      }
    }
    if (float* out = nodes_[node]->doubts) {
      for (std::size_t p = 0; p < averages; ++p) {
        out[p] = static_cast<float>(doubts_[node * averages + p]);
      }
    }
  }
}

}  // namespace freqsynth
