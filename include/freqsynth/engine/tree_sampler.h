// SPDX-License-Identifier: MIT
/// \file
/// Sampling with a tree of nodes: chooses positions a wave at a time, takes their values, splits
/// nodes. What is known after a number of samples depends on the settings, the numbers of samples
/// asked for and the values alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_queue.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/engine/pixel_counts.h"
#include "freqsynth/engine/split_rule.h"
#include "freqsynth/engine/tree_settings.h"
#include "freqsynth/engine/tree_steering.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// What a TreeSampler has done so far.
struct TreeStats {
  std::uint64_t samples = 0;   ///< values that were taken in
  std::uint64_t absorbed = 0;  ///< samples of nodes: a value may be one of several
  std::uint64_t waves = 0;     ///< that were complete
  std::uint64_t splits = 0;    ///< nodes that were split
  std::uint64_t bad = 0;       ///< samples with a value that was not usable
};

/// Samples a function, adaptively. Not for several threads at once; but the values of a wave do not
/// depend on each other.
///
/// The leaf that comes next is the one with the greatest
///   pixels * sigma^2 v_n / n
/// (see KrigingRefiner), where `pixels` is its area, the square of it below one pixel, and sigma^2
/// is pooled with that of the eight blocks around, or with that of its siblings. Leaves with fewer
/// than 5 samples come before all others.
class TreeSampler {
 public:
  /// Samples after which a node is split, unless it goes on as one.
  static constexpr std::size_t split_at = 81;
  /// Samples after which a node is split in any case, or complete where none may be deeper.
  static constexpr std::size_t most = 289;

  /// \param rule  must live as long as the sampler; none: no node goes on as one
  /// \throws std::invalid_argument naming a setting that is out of range.
  explicit TreeSampler(const TreeSettings& settings, SplitRule* rule = nullptr);
  TreeSampler(const TreeSampler&) = delete;
  TreeSampler& operator=(const TreeSampler&) = delete;

  /// All nodes.
  [[nodiscard]] const NodeTree& tree() const { return tree_; }
  /// The settings.
  [[nodiscard]] const TreeSettings& settings() const { return settings_; }
  /// Counters.
  [[nodiscard]] TreeStats stats() const;

  /// Chooses the next wave of at most so many positions; none when `most` is 0 or all leaves are
  /// complete. The one before has been taken in, or is forgotten. Valid until the next call.
  /// \throws std::bad_alloc; the sampler must not be used any more then.
  std::span<const Request> choose(std::uint64_t at_most);
  /// Takes the values of the wave, one per channel and position. A value that is not usable is
  /// replaced by what the node expects.
  /// \throws std::invalid_argument when there are more or fewer, and nothing is taken;
  ///         std::bad_alloc; the sampler must not be used any more then.
  void take_in(std::span<const float> values);

  /// Takes samples until there are so many in all, or none is left to take.
  /// \param sampler  see Sampler
  template <class F>
  void run(F&& sampler, std::uint64_t samples);

 private:
  /// Largest magnitude whose squares a node bears.
  static constexpr float most_value = 1e18f;

  void add_request(std::uint32_t leaf);
  void repair(std::uint32_t leaf);
  void note(std::uint32_t leaf);
  void end_of(std::uint32_t leaf);
  void settle();
  void update(std::uint32_t leaf);
  [[nodiscard]] float priority(std::uint32_t leaf) const;
  [[nodiscard]] double around(std::uint32_t leaf) const;

  TreeSettings settings_;
  SplitRule* rule_;
  NodePositions positions_;
  NodeTree tree_;
  TreeSteering steering_;
  BlockQueue queue_;
  PixelCounts pixels_;
  std::uint64_t frame_;  // the seed, mixed
  std::size_t leaves_;
  double scales_ = 0;  // of all blocks
  std::vector<Request> wave_;
  std::vector<std::uint32_t> owners_;        // of its positions
  std::unordered_set<std::uint64_t> asked_;  // the same on borders
  std::vector<std::uint32_t> chosen_;        // leaves, some of which ask for nothing of their own
  std::vector<std::uint32_t> touched_;       // leaves that have taken in something
  std::vector<std::uint32_t> ripe_;          // leaves that may have to be split
  std::vector<bool> is_touched_;
  std::vector<float> told_;  // the scale of each node that others know of
  std::vector<float> values_;
  std::vector<double> sums_;  // of the usable values of each channel
  std::vector<std::uint64_t> usable_;
  TreeStats stats_;
};

}  // namespace freqsynth

#include "freqsynth/engine/tree_sampler.inl"
