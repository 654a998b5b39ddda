// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/rounding.h"
#include "freqsynth/refine/bank_estimator.h"

namespace freqsynth {
namespace detail {

/// Log posterior of a member that was not tried.
inline constexpr double untried = -std::numeric_limits<double>::infinity();

/// The first sample of a node whose innovation is of the later half.
constexpr std::size_t later_half(std::size_t count) { return (count + 1) / 2; }

}  // namespace detail

FREQSYNTH_INLINE BankEstimator::BankEstimator(const BankLists& lists, std::size_t channels,
                                              const BankSettings& settings)
    : lists_(lists), channels_(channels), settings_(settings) {
  detail::require(channels >= 1 && channels <= 4096, "channels", static_cast<double>(channels),
                  "in 1..4096");
  detail::require(settings.temper >= 1 && settings.temper <= 1e6, "temper", settings.temper,
                  "in 1..1e6");
  detail::require(settings.inherit >= 0 && settings.inherit <= 1, "inherit", settings.inherit,
                  "in 0..1");
  detail::require(settings.badly >= 0 && settings.badly <= 100, "badly", settings.badly,
                  "in 0..100");
  const AverageGrid& grid = lists.grid();
  for (std::size_t p = 0; p < grid.count(); ++p) {
    const auto within = [&](std::size_t k) {
      const double middle = grid.origin + (static_cast<double>(k) + 0.5) * grid.edge;
      return middle > 0 && middle < 1;
    };
    inside_.push_back(within(p % grid.side) && within(p / grid.side));
    inside_count_ += inside_.back() ? 1 : 0;
  }
  detail::require(inside_count_ > 0, "averages within the node", 0, "at least 1");
}

FREQSYNTH_INLINE void BankEstimator::estimate(std::span<BankNode> nodes) {
  for (const BankNode& node : nodes) {
    detail::require(node.count >= 1 && node.count <= lists_.max_samples(), "count",
                    static_cast<double>(node.count), "a number of samples that the lists have");
  }
  constexpr std::size_t at_once = 512;
  for (std::size_t first = 0; first < nodes.size(); first += at_once) {
    load(nodes.subspan(first, std::min(at_once, nodes.size() - first)));
    weigh_all();
    choose();
    for (std::size_t member = 0; member < lists_.size(); ++member) average(member);
    store();
  }
}

/// Sorts the nodes, and writes their values less the mean of each lane side by side.
FREQSYNTH_ROUNDING inline void BankEstimator::load(std::span<BankNode> nodes) {
  FREQSYNTH_ROUNDING_BEGIN
  nodes_.clear();
  for (BankNode& node : nodes) nodes_.push_back(&node);
  std::stable_sort(nodes_.begin(), nodes_.end(),
                   [](const BankNode* a, const BankNode* b) { return a->count > b->count; });
  all_.resize(nodes_.size());
  std::iota(all_.begin(), all_.end(), 0u);
  lanes_ = nodes_.size() * channels_;
  values_.assign(nodes_.front()->count * lanes_, 0);
  bases_.resize(lanes_);
  floors_.assign(nodes_.size(), 0);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const BankNode& node = *nodes_[i];
    for (std::size_t c = 0; c < channels_; ++c) {
      double sum = 0, greatest = 0;
      for (std::size_t k = 0; k < node.count; ++k) {
        const double value = double{node.values[k * channels_ + c]};
        sum += value;
        greatest = std::max(greatest, value < 0 ? -value : value);
      }
      const std::size_t lane = i * channels_ + c;
      const auto base = static_cast<float>(sum / static_cast<double>(node.count));
      bases_[lane] = base;
      for (std::size_t k = 0; k < node.count; ++k) {
        values_[k * lanes_ + lane] = node.values[k * channels_ + c] - base;
      }
      // What rounding to float adds to each sample.
      const double rounding = 0x1p-24 * greatest;
      floors_[i] += rounding * rounding * static_cast<double>(node.count);
    }
  }
  evidence_.assign(nodes_.size() * lists_.size(), detail::untried);
  squares_.assign(nodes_.size() * lists_.size(), 0);
  best_.assign(nodes_.size(), detail::untried);
  errors_.assign(nodes_.size() * lists_.grid().count(), 0);
  doubts_.assign(errors_.size(), 0);
  averages_.assign(lanes_ * lists_.grid().count(), 0);
}

/// Computes innovations of some nodes' first samples, and with `sums` their averages. Calls
/// done(node, channel, sum of squares, lane in the chunk) for each lane.
template <class Done>
FREQSYNTH_ROUNDING void BankEstimator::innovate(const InnovationList& list,
                                                std::span<const std::uint32_t> which,
                                                std::size_t at_most, bool sums, Done done) {
  FREQSYNTH_ROUNDING_BEGIN
  constexpr std::size_t width = detail::lane_count;
  if (which.empty()) return;
  const std::size_t most = std::min(nodes_[which.front()]->count, at_most);
  list.reserve(most);
  const std::size_t averages = list.grid().count();
  chunk_.resize(width);
  innovations_.resize(std::max(innovations_.size(), most * width));
  if (sums) {
    sums_.resize(averages * width);
    later_.assign(nodes_.size(), 0);
  }
  const std::size_t lanes = which.size() * channels_;
  for (std::size_t first = 0; first < lanes; first += width) {
    const std::size_t used = std::min(width, lanes - first);
    std::size_t from[width];
    float squares[width] = {}, earlier[width] = {};
    std::size_t half[width] = {};
    for (std::size_t l = 0; l < used; ++l) {
      from[l] = which[(first + l) / channels_] * channels_ + (first + l) % channels_;
      half[l] = detail::later_half(nodes_[from[l] / channels_]->count);
    }
    std::fill(chunk_.begin(), chunk_.end(), 0.0f);
    if (sums) std::fill(sums_.begin(), sums_.end(), 0.0f);
    std::size_t active = used;
    const std::size_t rows = std::min(nodes_[from[0] / channels_]->count, at_most);
    for (std::size_t i = 0; i < rows; ++i) {
      while (nodes_[from[active - 1] / channels_]->count <= i) --active;
      const float* values = values_.data() + i * lanes_;
      for (std::size_t l = 0; l < used; ++l) chunk_[l] = values[from[l]];
      const InnovationRow& row = list.row(i);
      float* z = innovations_.data() + i * width;
      detail::innovate_lanes(row.factor.data(), i, row.inverse_pivot, chunk_.data(),
                             innovations_.data());
      // Nodes whose samples are used up have no more innovations.
      for (std::size_t l = active; l < width; ++l) z[l] = 0;
      if (i > 0) {
        for (std::size_t l = 0; l < width; ++l) {
          squares[l] += z[l] * z[l];
          if (i < half[l]) earlier[l] = squares[l];
        }
      }
      if (sums) detail::add_lanes(row.gains.data(), averages, z, sums_.data());
    }
    for (std::size_t l = 0; l < used; ++l) {
      if (sums) later_[from[l] / channels_] += double{squares[l] - earlier[l]};
      done(from[l] / channels_, from[l] % channels_, squares[l], l);
    }
  }
}

/// Of the first samples of a node, at the scale that makes them most likely.
FREQSYNTH_ROUNDING inline double BankEstimator::log_evidence(double squares, std::size_t node,
                                                             const InnovationList& list,
                                                             std::size_t samples) const {
  FREQSYNTH_ROUNDING_BEGIN
  if (samples == 1) return 0;
  return -0.5 *
         (static_cast<double>(samples - 1) * detail::log_of(squares + floors_[node] + 1e-60) +
          list.row(samples - 1).log_determinant);
}

FREQSYNTH_ROUNDING inline void BankEstimator::weigh(std::size_t member,
                                                    std::span<const std::uint32_t> which) {
  FREQSYNTH_ROUNDING_BEGIN
  const std::size_t members = lists_.size();
  innovate(lists_[member], which, lists_.max_samples(), false,
           [&](std::size_t node, std::size_t, float squares, std::size_t) {
             squares_[node * members + member] += double{squares};
           });
  for (const std::uint32_t node : which) {
    const BankNode& known = *nodes_[node];
    double evidence =
        log_evidence(squares_[node * members + member], node, lists_[member], known.count);
    best_[node] = std::max(best_[node], evidence);
    evidence /= settings_.temper;
    if (known.parent != nullptr && double{known.parent[member]} > detail::untried) {
      evidence += settings_.inherit * double{known.parent[member]};
    }
    evidence_[node * members + member] = evidence;
  }
}

FREQSYNTH_INLINE void BankEstimator::weigh_all() {
  for (const PriorGroup& group : lists_.bank().groups()) {
    if (group.directions) {
      weigh_directions(group);
    } else if (group.waves) {
      if (lists_.tries_waves()) weigh_waves(group);
    } else {
      for (std::size_t k = 0; k < group.count; ++k) weigh(group.first + k, all_);
    }
  }
}

/// Four directions, and then by halves those beside the best of each node.
FREQSYNTH_INLINE void BankEstimator::weigh_directions(const PriorGroup& group) {
  const std::size_t members = lists_.size();
  std::size_t step = group.count / 4;
  for (std::size_t k = 0; k < group.count; k += step) weigh(group.first + k, all_);
  std::vector<std::size_t> best(nodes_.size());
  for (step /= 2; step > 0; step /= 2) {
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      const double* own = evidence_.data() + node * members + group.first;
      best[node] = static_cast<std::size_t>(std::max_element(own, own + group.count) - own);
    }
    for (std::size_t k = step; k < group.count; k += 2 * step) {
      some_.clear();
      for (const std::uint32_t node : all_) {
        const std::size_t off = (k + group.count - best[node]) % group.count;
        if (off == step || off == group.count - step) some_.push_back(node);
      }
      weigh(group.first + k, some_);
    }
  }
}

}  // namespace freqsynth

#include "freqsynth/refine/bank_estimator_average.inl"
#include "freqsynth/refine/bank_estimator_waves.inl"
