// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/engine/tree_sampler_choice.inl"
#include "freqsynth/engine/tree_sampler_taking.inl"

namespace freqsynth {
namespace detail {

/// The settings, when they are in range.
inline const TreeSettings& checked(const TreeSettings& settings) {
  settings.validate();
  return settings;
}

/// Weights whose sum is 1; of no channel's weight, all the same.
inline std::vector<float> normalized(std::vector<float> weights) {
  double sum = 0;
  for (const float weight : weights) sum += double{weight};
  for (float& weight : weights) {
    weight = static_cast<float>(sum > 0 ? weight / sum : 1 / static_cast<double>(weights.size()));
  }
  return weights;
}

}  // namespace detail

inline TreeSampler::TreeSampler(const TreeSettings& settings, SplitRule* rule)
    : settings_(detail::checked(settings)),
      rule_(rule),
      positions_(settings.seed, settings.noisy ? 0 : settings.perturbation),
      tree_(BlockGrid::of(settings.width, settings.height, settings.weights.size()), positions_,
            settings.noisy        ? NodePositions::size
            : settings.depth == 0 ? most
                                  : split_at,
            detail::normalized(settings.weights),
            settings.noisy ? KrigingRefiner::noise_of_estimates : KrigingRefiner::noise_of_detail),
      steering_(settings.steer, settings.exposure, settings.weights.size()),
      queue_(tree_.size()),
      behind_(tree_.size()),
      frame_(detail::mix_bits(settings.seed + detail::golden_step)),
      leaves_(tree_.size()),
      is_touched_(tree_.size()),
      told_(tree_.size()),
      values_(tree_.channels()),
      sums_(tree_.channels()),
      usable_(tree_.channels()) {
  if (settings_.noisy) settings_.depth = 0;
  use_factors({});
}

inline TreeStats TreeSampler::stats() const {
  TreeStats stats = stats_;
  stats.absorbed = tree_.absorbed();
  return stats;
}

/// Mean squared scale of the nodes beside a leaf.
inline double TreeSampler::around(std::uint32_t leaf) const {
  const TreeNode& node = tree_.node(leaf);
  double sum = 0;
  if (node.depth > 0) {
    const std::uint32_t first = tree_.node(node.parent).quadrants;
    for (std::uint32_t k = 0; k < 4; ++k) sum += double{tree_.node(first + k).scale};
    return sum / 4;
  }
  int count = 0;
  tree_.visit_blocks_around(leaf, [&](std::uint32_t other) {
    sum += double{tree_.node(other).scale};
    ++count;
  });
  return count > 0 ? sum / count : 0;
}

inline float TreeSampler::priority(std::uint32_t leaf) const {
  constexpr std::size_t first = 5;
  constexpr float urgent = 1e30f, doubt = 1e-12f;
  const TreeNode& node = tree_.node(leaf);
  if (!node.leaf() || node.complete()) return BlockQueue::absent;
  const double factor = factors_.empty() ? 1 : double{factors_[node.block]};
  if (factor == 0 && node.samples > 0) return BlockQueue::absent;
  if (node.samples < first) return urgent / static_cast<float>(node.samples + 1);
  const double mean = scales_ / static_cast<double>(tree_.grid().size());
  const double squares = tree_.squares(leaf) + double{doubt} * mean;
  const double scale = KrigingRefiner::scale(squares, node.samples, around(leaf));
  const double area = tree_.area(leaf);
  const double share = area < 1 ? area * area : area;
  const double gain = factor * share * scale *
                      double{tree_.refiner().variance(node.of, node.samples)} /
                      static_cast<double>(node.samples);
  return static_cast<float>(std::min(gain, double{most_gain}));
}

/// Once every block has had a sample, their priorities become others.
inline void TreeSampler::settle() {
  const auto blocks = static_cast<std::uint32_t>(tree_.grid().size());
  for (std::uint32_t block = 0; block < blocks; ++block) {
    const TreeNode& node = tree_.node(block);
    if (node.leaf() && node.samples == 0) return;
  }
  steering_.settle(tree_);
  if (steering_.linear()) return;
  scales_ = 0;
  for (std::uint32_t number = 0; number < tree_.size(); ++number) {
    told_[number] = tree_.node(number).scale;
    if (number < blocks) scales_ += double{told_[number]};
  }
  for (std::uint32_t leaf = 0; leaf < tree_.size(); ++leaf) place(leaf, priority(leaf));
}

/// Puts a leaf where it belongs in the queue, and those beside it that have to hear of it.
inline void TreeSampler::update(std::uint32_t leaf) {
  steering_.look_at(tree_, leaf);
  const TreeNode& node = tree_.node(leaf);
  const float scale = node.scale;
  place(leaf, priority(leaf));
  const bool news = scale > 1.25f * told_[leaf] || scale < 0.8f * told_[leaf];
  if (!news) return;
  if (node.depth == 0) scales_ += double{scale} - double{told_[leaf]};
  told_[leaf] = scale;
  const auto tell = [this](std::uint32_t other) {
    if (queue_.priority(other) != BlockQueue::absent) place(other, priority(other));
  };
  if (node.depth == 0) {
    tree_.visit_blocks_around(leaf, tell);
  } else {
    const std::uint32_t first = tree_.node(node.parent).quadrants;
    for (std::uint32_t k = 0; k < 4; ++k) tell(first + k);
  }
}

template <class F>
void TreeSampler::run(F&& sampler, std::uint64_t samples) {
  detail::check_sampler<std::remove_cvref_t<F>>();
  std::vector<float> values;
  while (stats_.samples < samples) {
    const std::span<const Request> wave = choose(samples - stats_.samples);
    if (wave.empty()) return;
    values.resize(wave.size() * tree_.channels());
    std::size_t done = 0;
    detail::call_sampler(sampler, wave, std::span<float>(values), done);
    take_in(values);
  }
}

}  // namespace freqsynth
