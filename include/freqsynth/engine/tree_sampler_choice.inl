// SPDX-License-Identifier: MIT
// How the samples of a wave are chosen.
#pragma once

#include <algorithm>
#include <cmath>

#include "freqsynth/basis/mix_bits.h"

namespace freqsynth {

inline void TreeSampler::use_factors(std::vector<float> factors) {
  FREQSYNTH_ASSERT(factors.empty() || factors.size() == tree_.grid().size());
  factors_ = std::move(factors);
  area_ = 0;
  for (std::uint32_t block = 0; block < tree_.grid().size(); ++block) {
    if (factors_.empty() || factors_[block] > 0) area_ += tree_.area(block) / max_terms;
  }
  for (std::uint32_t leaf = 0; leaf < tree_.size(); ++leaf) place(leaf, priority(leaf));
  for (const std::uint32_t leaf : chosen_) place(leaf, BlockQueue::absent);
}

inline std::span<const Request> TreeSampler::choose(std::uint64_t at_most) {
  if (!pixels_) pixels_.emplace(tree_.grid());
  plan({.samples = at_most});
  pixels_->reserve(wave_.size());
  for (Request& request : wave_) {
    request.pixel = pixels_->pixel({request.x, request.y});
    request.ordinal = pixels_->next(request.pixel);
  }
  return wave_;
}

inline std::span<const Request> TreeSampler::plan(const Limits& limits) {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(usual_wave(), limits.samples));
  // Afterwards nothing can fail.
  chosen_.reserve(std::max(size, chosen_.size()));
  owners_.reserve(size);
  wave_.reserve(size);
  borders_.reserve(size);
  for (const std::uint32_t leaf : chosen_) place(leaf, priority(leaf));
  chosen_.clear();
  wave_.clear();
  owners_.clear();
  if (settings_.exploration > 0) take_lagging(size);
  while (chosen_.size() < size && double{queue_.top_priority()} > limits.priority) {
    take(static_cast<std::uint32_t>(queue_.top()));
  }
  const auto blocks = static_cast<std::uint32_t>(limits.least > 0 ? tree_.grid().size() : 0);
  for (std::uint32_t block = 0; block < blocks && chosen_.size() < size; ++block) {
    const bool wanted = queue_.priority(block) != BlockQueue::absent;
    if (wanted && tree_.node(block).samples < limits.least) take(block);
  }
  ask();
  return wave_;
}

inline bool TreeSampler::complete() const {
  for (std::uint32_t leaf = 0; leaf < tree_.size(); ++leaf) {
    if (tree_.node(leaf).leaf() && !tree_.node(leaf).complete()) return false;
  }
  return true;
}

/// Puts a leaf where it belongs in both queues; none, where it is absent.
inline void TreeSampler::place(std::uint32_t leaf, float priority) {
  queue_.update(leaf, priority);
  if (settings_.exploration == 0) return;
  behind_.update(leaf, priority == BlockQueue::absent ? priority : behind(leaf));
}

/// Chooses leaves that have had few samples, or few for their area.
inline void TreeSampler::take_lagging(std::size_t size) {
  while (chosen_.size() < size && queue_.top_priority() > most_gain) {
    take(static_cast<std::uint32_t>(queue_.top()));
  }
  if (area_ == 0) return;
  const double mean = static_cast<double>(stats_.samples) / area_;
  const double least = std::pow(mean, settings_.exploration);
  // Those that are absent are below all.
  while (chosen_.size() < size && double{behind_.top_priority()} > -least) {
    take(static_cast<std::uint32_t>(behind_.top()));
  }
}

/// The fewer samples a leaf has for its area, the greater.
inline float TreeSampler::behind(std::uint32_t leaf) const {
  return static_cast<float>(-double{max_terms} * tree_.node(leaf).samples / tree_.area(leaf));
}

/// Chooses a leaf for the wave, for which there is room.
inline void TreeSampler::take(std::uint32_t leaf) {
  place(leaf, BlockQueue::absent);
  chosen_.push_back(leaf);
}

/// Makes the wave of the leaves that are chosen. What several of them ask for, on a border, the
/// first one does.
inline void TreeSampler::ask() {
  std::sort(chosen_.begin(), chosen_.end());
  borders_.clear();
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const TreeNode& node = tree_.node(chosen_[i]);
    if (!NodePositions::on_border(positions_.homes()[node.samples])) continue;
    borders_.push_back({name_of(tree_.place(chosen_[i], node.samples)), i});
  }
  std::sort(borders_.begin(), borders_.end(), [](const Border& a, const Border& b) {
    return a.name != b.name ? a.name < b.name : a.number < b.number;
  });
  std::size_t skipped = 0;
  std::uint64_t name = 0;
  for (std::size_t i = 0; i < borders_.size(); ++i) {
    const Border one = borders_[i];
    if (i > 0 && one.name == name) borders_[skipped++] = one;
    name = one.name;
  }
  borders_.resize(skipped);
  std::sort(borders_.begin(), borders_.end(),
            [](const Border& a, const Border& b) { return a.number < b.number; });
  auto skip = borders_.begin();
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    if (skip != borders_.end() && skip->number == i) {
      ++skip;
    } else {
      add_request(chosen_[i]);
    }
  }
}

/// Asks for the next sample of a leaf.
inline void TreeSampler::add_request(std::uint32_t leaf) {
  const TreeNode& node = tree_.node(leaf);
  const TreePlace place = tree_.place(leaf, node.samples);
  const BlockGrid& grid = tree_.grid();
  const BlockGrid::Point point = tree_.point(place);
  const std::size_t edge = std::min(grid.block_width(node.block), grid.block_height(node.block));
  Request request;
  request.x = point.x;
  request.y = point.y;
  request.id = name_of(place);
  request.spacing =
      std::ldexp(positions_.spacing(node.samples) * static_cast<float>(edge), -int{node.depth});
  request.slot = static_cast<std::uint32_t>(wave_.size());
  request.seed = detail::mix_bits(request.id * detail::golden_step + frame_);
  wave_.push_back(request);
  owners_.push_back(leaf);
}

}  // namespace freqsynth
