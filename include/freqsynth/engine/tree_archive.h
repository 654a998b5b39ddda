// SPDX-License-Identifier: MIT
/// \file
/// What is saved of a tree of nodes and of what samples with it (archive.h has the form), and what
/// a saved one must hold to be taken. Of the nodes these are what they have been told; innovations
/// follow from that.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/block_queue.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/engine/state_archive.h"
#include "freqsynth/engine/tree_sampler.h"

namespace freqsynth {

/// \cond internal
/// Each member lists a part for an archive, to be saved or to be loaded into one that is as new.
struct TreeArchive {
  /// A sampler, whose wave may be under way.
  template <class Archive, class Sampler>
  static void sampler(Archive& archive, Sampler& sampler) {
    archive.section("TREE", [&] { shape(archive, sampler.tree_); });
    archive.section("VALS", [&] { values(archive, sampler.tree_); });
    archive.section("KEPT", [&] { kept(archive, sampler.tree_); });
    if constexpr (Archive::loading) check_next(archive, sampler.tree_);
    archive.section("STER", [&] { steering(archive, sampler.steering_); });
    archive.section("CHOI", [&] { choice(archive, sampler); });
  }

 private:
  /// A number that sums and products of bear.
  static bool in_range(double value, double most) {
    return detail::is_finite(value) && value >= 0 && value <= most;
  }

  template <class Archive, class Tree>
  static void shape(Archive& archive, Tree& tree);
  template <class Archive, class Node>
  static void node(Archive& archive, Node& node);
  template <class Archive, class Tree>
  static void values(Archive& archive, Tree& tree);
  static void innovate(NodeTree& tree, std::uint32_t leaf);
  template <class Archive, class Tree>
  static void kept(Archive& archive, Tree& tree);
  template <class Archive>
  static void check_next(Archive& archive, NodeTree& tree);
  template <class Archive, class Steering>
  static void steering(Archive& archive, Steering& steering);
  template <class Archive, class Sampler>
  static void choice(Archive& archive, Sampler& sampler);
  template <class Archive, class Sampler>
  static void chosen(Archive& archive, Sampler& sampler);
};

// ------------------------------------------------------------------------------------ definitions

/// Which nodes were split, in this order, and numbers of all.
template <class Archive, class Tree>
void TreeArchive::shape(Archive& archive, Tree& tree) {
  const std::size_t blocks = tree.grid().size();
  std::vector<std::uint32_t> parents;
  for (std::size_t i = blocks; i < tree.size(); i += 4) parents.push_back(tree.nodes_[i].parent);
  archive.list(parents, std::numeric_limits<std::uint32_t>::max() / 8);
  if constexpr (Archive::loading) {
    for (const std::uint32_t parent : parents) {
      archive.check(parent < tree.size() && tree.nodes_[parent].leaf() &&
                    tree.nodes_[parent].depth < NodeTree::deepest);
      tree.add_quadrants(parent);
    }
  }
  for (auto& one : tree.nodes_) node(archive, one);
  archive.number(tree.absorbed_);
}

template <class Archive, class Node>
void TreeArchive::node(Archive& archive, Node& node) {
  archive.number(node.limit);
  archive.number(node.samples);
  archive.number(node.held);
  std::uint32_t corners = node.held_corners;
  archive.number(corners);
  archive.number(node.scale);
  archive.check(node.limit <= NodePositions::size && NodePositions::handed_down(node.limit) != 0 &&
                node.samples <= node.limit && node.held <= node.limit && corners < 16);
  if constexpr (Archive::loading) node.held_corners = static_cast<std::uint8_t>(corners);
  archive.check(in_range(double{node.scale}, 1e30));
}

/// Of each leaf that has been told something, in each channel, and its factors.
template <class Archive, class Tree>
void TreeArchive::values(Archive& archive, Tree& tree) {
  const std::size_t channels = tree.channels();
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    auto& node = tree.nodes_[leaf];
    const std::size_t size = std::max(node.samples, node.held);
    if (!node.leaf() || size == 0) continue;
    if constexpr (Archive::loading) tree.store_.enlarge(node.chunk, 0, size);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::span<float> row(tree.store_.row(node.chunk, 2 * c), size);
      archive.array(row);
      for (const float value : row) archive.check(TreeSampler::usable(value));
    }
    const std::span<float> factors(node.chunk.data + channels, channels);
    archive.array(factors);
    for (const float factor : factors) archive.check(in_range(double{factor}, 1e38));
    if constexpr (Archive::loading) innovate(tree, leaf);
  }
}

/// The innovations of a leaf, as NodeTree::absorb() makes them.
inline void TreeArchive::innovate(NodeTree& tree, std::uint32_t leaf) {
  const TreeNode& node = tree.nodes_[leaf];
  for (std::size_t c = 0; c < tree.channels(); ++c) {
    const float* known = tree.store_.row(node.chunk, 2 * c);
    float* innovations = tree.store_.row(node.chunk, 2 * c + 1);
    for (std::size_t i = 1; i < node.samples; ++i) {
      const InnovationRow& row = tree.refiner_.list(node.of).row(i);
      innovations[i] = innovation_of(row, innovations, known[i] - known[0]);
      node.chunk.data[c] += innovations[i] * innovations[i];
    }
  }
}

/// By their places, so that the same tree has the same bytes.
template <class Archive, class Tree>
void TreeArchive::kept(Archive& archive, Tree& tree) {
  std::vector<std::uint64_t> places;
  for (const auto& one : tree.kept_) places.push_back(one.first);
  std::sort(places.begin(), places.end());
  archive.list(places, std::numeric_limits<std::uint32_t>::max());
  const std::size_t channels = tree.channels();
  for (const std::uint64_t place : places) {
    if constexpr (Archive::loading) {
      archive.check(tree.kept_.emplace(place, tree.kept_values_.size()).second);
      tree.kept_values_.resize(tree.kept_values_.size() + channels);
    }
    const std::size_t at = tree.kept_.find(place)->second;
    archive.array(std::span(tree.kept_values_.data() + at, channels));
    for (std::size_t c = 0; c < channels; ++c) {
      archive.check(TreeSampler::usable(tree.kept_values_[at + c]));
    }
  }
}

/// No leaf's next sample may be one that is known.
template <class Archive>
void TreeArchive::check_next(Archive& archive, NodeTree& tree) {
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const TreeNode& node = tree.nodes_[leaf];
    archive.check(!node.leaf() || node.complete() || !tree.find_next(leaf));
  }
}

template <class Archive, class Steering>
void TreeArchive::steering(Archive& archive, Steering& steering) {
  archive.number(steering.settled_);
  archive.array(steering.levels_);
  for (const double level : steering.levels_) archive.check(level > 0 && in_range(level, 1e38));
}

template <class Archive, class Sampler>
void TreeArchive::choice(Archive& archive, Sampler& sampler) {
  const NodeTree& tree = sampler.tree_;
  if constexpr (Archive::loading) {
    sampler.queue_.grow(tree.size());
    if (sampler.settings_.exploration > 0) sampler.behind_.grow(tree.size());
    sampler.is_touched_.resize(tree.size());
    sampler.told_.resize(tree.size());
    sampler.leaves_ = tree.size() - (tree.size() - tree.grid().size()) / 4;
  }
  archive.number(sampler.stats_.samples);
  archive.number(sampler.stats_.waves);
  archive.number(sampler.stats_.splits);
  archive.number(sampler.stats_.bad);
  archive.array(sampler.sums_);
  archive.array(sampler.usable_);
  for (std::size_t c = 0; c < sampler.sums_.size(); ++c) {
    const double most = double{TreeSampler::most_value} * static_cast<double>(sampler.usable_[c]);
    archive.check(in_range(std::abs(sampler.sums_[c]), most));
  }
  archive.number(sampler.scales_);
  // Their sum may be below zero, by rounding.
  archive.check(in_range(std::abs(sampler.scales_), 1e40));
  archive.array(sampler.told_);
  for (const float told : sampler.told_) archive.check(in_range(double{told}, 1e30));
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    float priority = sampler.queue_.priority(leaf);
    archive.number(priority);
    const bool open = tree.node(leaf).leaf() && !tree.node(leaf).complete();
    archive.check(detail::is_finite(priority) && (open || priority == BlockQueue::absent));
    if constexpr (Archive::loading) sampler.place(leaf, priority);
  }
  archive.list(sampler.factors_, tree.grid().size());
  archive.check(sampler.factors_.empty() || sampler.factors_.size() == tree.grid().size());
  for (const float factor : sampler.factors_) archive.check(in_range(double{factor}, 1e6));
  chosen(archive, sampler);
}

/// The leaves that were chosen last; the wave is made of them anew.
template <class Archive, class Sampler>
void TreeArchive::chosen(Archive& archive, Sampler& sampler) {
  bool under_way = !sampler.wave_.empty();
  archive.number(under_way);
  archive.list(sampler.chosen_, sampler.tree_.size());
  if constexpr (Archive::loading) {
    for (std::size_t i = 0; i < sampler.chosen_.size(); ++i) {
      const std::uint32_t leaf = sampler.chosen_[i];
      archive.check(leaf < sampler.tree_.size() && (i == 0 || leaf > sampler.chosen_[i - 1]));
      const TreeNode& node = sampler.tree_.node(leaf);
      archive.check(!under_way || (node.leaf() && !node.complete()));
    }
    archive.check(!under_way || !sampler.chosen_.empty());
    if (under_way) sampler.ask();
  }
}

/// \endcond

}  // namespace freqsynth
