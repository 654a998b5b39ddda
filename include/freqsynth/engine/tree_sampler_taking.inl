// SPDX-License-Identifier: MIT
// How the values of a wave are taken in.
//
// Whatever may run out of memory comes before what it is for, and how far it has come is known: so
// the same call goes on where it ended, and comes to the same.
#pragma once

#include <algorithm>
#include <string>

#include "freqsynth/basis/check.h"

namespace freqsynth {

inline void TreeSampler::take_in(std::span<const float> values) {
  const std::size_t channels = tree_.channels();
  if (values.size() != wave_.size() * channels) {
    detail::refuse(std::to_string(values.size()) + " values for " + std::to_string(wave_.size()) +
                   " requests of " + std::to_string(channels) + " channels");
  }
  for (; taking_.sample < wave_.size(); ++taking_.sample) {
    const std::uint32_t leaf = owners_[taking_.sample];
    reserve_notes();
    if (!taking_.own) take_own(leaf, values.data() + taking_.sample * channels);
    take_from_others();
    taking_.own = false;
  }
  // More may come as nodes are split.
  for (; taking_.ripe < ripe_.size(); ++taking_.ripe) end_of(ripe_[taking_.ripe]);
  if (!steering_.settled()) settle();
  // From here on nothing fails.
  stats_.samples += wave_.size();
  ++stats_.waves;
  wave_.clear();
  owners_.clear();
  ripe_.clear();
  for (const std::uint32_t leaf : touched_) is_touched_[leaf] = false;
  for (const std::uint32_t leaf : touched_) update(leaf);
  touched_.clear();
  taking_ = {};
}

/// Gives a leaf the sample that it has asked for.
inline void TreeSampler::take_own(std::uint32_t leaf, const float* values) {
  tree_.reserve_next(leaf);
  const TreePlace home = tree_.home(leaf, tree_.node(leaf).samples);
  std::copy_n(values, values_.size(), values_.begin());
  repair(leaf);
  tree_.absorb(leaf, values_.data());
  taking_.own = true;
  taking_.others[0] = leaf;
  taking_.count = 1;
  taking_.other = 0;
  tree_.visit_touching(home, [&](std::uint32_t other, const NodePosition&) {
    if (other != leaf) taking_.others[taking_.count++] = other;
  });
}

/// Lets it, and those that touch its home, take in what they know by now.
inline void TreeSampler::take_from_others() {
  for (; taking_.other < taking_.count; ++taking_.other) {
    advance(taking_.others[taking_.other], taking_.other == 0);
  }
}

/// Lets a leaf take in what it knows, and notes it when it does, or there were news of it before.
/// What has failed to come in comes when this goes on, and so does the note.
inline void TreeSampler::advance(std::uint32_t leaf, bool news) {
  if (tree_.advance(leaf) > 0 || news) note(leaf);
}

/// Puts what is expected in the place of values that are not usable.
inline void TreeSampler::repair(std::uint32_t leaf) {
  bool bad = false;
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (usable(values_[c])) {
      sums_[c] += double{values_[c]};
      ++usable_[c];
      continue;
    }
    bad = true;
    values_[c] = tree_.node(leaf).samples > 0 ? tree_.prediction(leaf, c)
                 : usable_[c] > 0 ? static_cast<float>(sums_[c] / static_cast<double>(usable_[c]))
                                  : 0.0f;
  }
  stats_.bad += bad ? 1 : 0;
}

/// Makes room for the notes of a sample, or of a split.
inline void TreeSampler::reserve_notes() {
  constexpr std::size_t room = 8;
  for (std::vector<std::uint32_t>* list : {&touched_, &ripe_}) {
    if (list->capacity() < list->size() + room) list->reserve(2 * list->size() + room);
  }
}

/// A leaf has taken in samples.
inline void TreeSampler::note(std::uint32_t leaf) {
  if (tree_.node(leaf).complete()) ripe_.push_back(leaf);
  if (is_touched_[leaf]) return;
  is_touched_[leaf] = true;
  touched_.push_back(leaf);
}

/// A leaf has had all samples that it was to have.
inline void TreeSampler::end_of(std::uint32_t leaf) {
  if (taking_.growing_count == 0) begin_end_of(leaf);
  for (; taking_.grown < taking_.growing_count; ++taking_.grown) {
    tree_.advance(taking_.growing[taking_.grown]);
  }
  for (std::size_t i = 0; i < taking_.growing_count; ++i) note(taking_.growing[i]);
  taking_.growing_count = taking_.grown = 0;
}

/// Lets it go on, or splits it; or neither. What may fail is done first.
inline void TreeSampler::begin_end_of(std::uint32_t leaf) {
  const TreeNode& node = tree_.node(leaf);
  if (!node.leaf() || !node.complete() || node.depth >= settings_.depth) return;
  reserve_notes();
  if (node.samples < most && rule_ != nullptr && rule_->goes_on(tree_, leaf)) {
    tree_.raise_limit(leaf, most);
    taking_.growing[taking_.growing_count++] = leaf;
    return;
  }
  reserve_split();
  const auto first = static_cast<std::uint32_t>(tree_.size());
  tree_.split(leaf, node.depth + std::size_t{1} < settings_.depth ? split_at : most);
  ++stats_.splits;
  leaves_ += 3;
  is_touched_.resize(tree_.size());
  told_.resize(tree_.size());
  for (std::uint32_t k = 0; k < 4; ++k) taking_.growing[taking_.growing_count++] = first + k;
}

/// Makes room for what is known of four more nodes.
inline void TreeSampler::reserve_split() {
  const std::size_t size = tree_.size() + 4;
  if (told_.capacity() < size) told_.reserve(2 * size);
  if (is_touched_.capacity() < size) is_touched_.reserve(2 * size);
  queue_.grow(size);
  if (settings_.exploration > 0) behind_.grow(size);
}

}  // namespace freqsynth
