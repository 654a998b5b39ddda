// SPDX-License-Identifier: MIT
// What a BankEstimator makes of priors that oscillate.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/rounding.h"

namespace freqsynth {

/// Those that all priors explain little better than white noise does.
FREQSYNTH_ROUNDING inline void BankEstimator::find_badly_explained() {
  FREQSYNTH_ROUNDING_BEGIN
  // With fewer samples, every wave explains all that is seen.
  constexpr std::size_t least = 13;
  badly_.clear();
  for (const std::uint32_t node : all_) {
    const std::size_t count = nodes_[node]->count;
    if (count < least || count > BankLists::wave_samples) continue;
    double squares = floors_[node] + 1e-60;
    for (std::size_t k = 0; k < count; ++k) {
      const float* values = values_.data() + k * lanes_ + node * channels_;
      for (std::size_t c = 0; c < channels_; ++c) squares += double{values[c]} * double{values[c]};
    }
    const auto samples = static_cast<double>(count);
    // The covariance of differences from the first sample has the determinant `samples`.
    const double white = -0.5 * ((samples - 1) * detail::log_of(squares) + detail::log_of(samples));
    if (best_[node] - white < settings_.badly * (samples - 1)) badly_.push_back(node);
  }
}

/// The first samples tell which waves are tried on all.
FREQSYNTH_INLINE void BankEstimator::weigh_waves(const PriorGroup& group) {
  constexpr std::size_t tried = 4;
  find_badly_explained();
  if (badly_.empty()) return;
  const auto place = [&](std::uint32_t node) {
    return static_cast<std::size_t>(std::lower_bound(badly_.begin(), badly_.end(), node) -
                                    badly_.begin());
  };
  std::vector<double> squares(badly_.size());
  probes_.resize(badly_.size() * group.count);
  for (std::size_t k = 0; k < group.count; ++k) {
    const InnovationList& list = lists_.probe(group.first + k);
    std::fill(squares.begin(), squares.end(), 0.0);
    innovate(list, badly_, BankLists::probe_samples, false,
             [&](std::size_t node, std::size_t, float sum, std::size_t) {
               squares[place(static_cast<std::uint32_t>(node))] += double{sum};
             });
    for (std::size_t i = 0; i < badly_.size(); ++i) {
      probes_[i * group.count + k] =
          log_evidence(squares[i], badly_[i], list,
                       std::min(nodes_[badly_[i]]->count, BankLists::probe_samples));
    }
  }
  choice_.assign(group.count, {});
  std::vector<std::size_t> order(group.count);
  for (std::size_t i = 0; i < badly_.size(); ++i) {
    const double* own = probes_.data() + i * group.count;
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t count = std::min(tried, group.count);
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
        [&](std::size_t a, std::size_t b) { return own[a] != own[b] ? own[a] > own[b] : a < b; });
    // Where these are all samples, a wave has to explain them better than all others do.
    const bool all = nodes_[badly_[i]]->count <= BankLists::probe_samples;
    for (std::size_t k = 0; k < count; ++k) {
      if (!all || own[order[k]] > best_[badly_[i]]) choice_[order[k]].push_back(badly_[i]);
    }
  }
  for (std::size_t k = 0; k < group.count; ++k) {
    if (!choice_[k].empty()) weigh(group.first + k, choice_[k]);
  }
}

}  // namespace freqsynth
