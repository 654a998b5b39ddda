// SPDX-License-Identifier: MIT
/// \file
/// Sampling with a tree of nodes: chooses positions a wave at a time, takes their values, splits
/// nodes. What is known after a number of samples depends on the settings, the numbers of samples
/// asked for and the values alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
/// than 5 samples come before all others, then those that lag behind (TreeSettings::exploration).
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
  /// Whether every block has had a sample.
  [[nodiscard]] bool all_sampled() const { return steering_.settled(); }
  /// Leaves that the next wave has, where there are so many that want samples.
  [[nodiscard]] std::size_t usual_wave() const {
    return settings_.wave != 0 ? settings_.wave : std::max<std::size_t>(leaves_ / 32, 1);
  }

  /// Factors on the priorities of all leaves of each block, not negative, from the next wave on;
  /// none: 1. With 0 a block is left at its first sample.
  void use_factors(std::vector<float> factors);
  /// What may be asked for.
  struct Limits {
    std::uint64_t samples = 0;  ///< positions, at most
    double priority = -1;       ///< leaves whose priority is not above it want no sample
    std::size_t least = 0;      ///< but blocks do that have had fewer samples
  };
  /// Chooses the next wave: none when no sample is allowed, or no leaf wants one. The one before
  /// has been taken in, or is forgotten. Valid until the next call. Pixels and
  /// ordinals are 0.
  /// \throws std::bad_alloc, and nothing has changed.
  std::span<const Request> plan(const Limits& limits);
  /// The same of at most so many positions, with ordinals. \throws std::bad_alloc.
  std::span<const Request> choose(std::uint64_t at_most);
  /// The leaf that asks for a position of the wave.
  [[nodiscard]] std::uint32_t owner(std::size_t position) const { return owners_[position]; }
  /// The positions of the wave; none once it is taken in.
  [[nodiscard]] std::span<const Request> planned() const { return wave_; }
  /// Whether all leaves have had all samples that they may have. Between waves.
  [[nodiscard]] bool complete() const;
  /// Whether a value is one that nodes take in.
  [[nodiscard]] static bool usable(float value) {
    return is_usable_sample(value) && std::abs(value) <= most_value;
  }
  /// Takes the values of the wave, one per channel and position. A value that is not usable is
  /// replaced by what the node expects.
  /// \throws std::invalid_argument when there are more or fewer, and nothing is taken;
  ///         std::bad_alloc: then it must be called again, with the same values, and goes on where
  ///         it was. Until then nothing but settings() may be asked.
  void take_in(std::span<const float> values);

  /// Takes samples until there are so many in all, or none is left to take.
  /// \param sampler  see Sampler
  template <class F>
  void run(F&& sampler, std::uint64_t samples);

 private:
  friend struct TreeArchive;

  /// Largest magnitude whose squares a node bears.
  static constexpr float most_value = 1e15f;
  /// Greatest priority of leaves that are not to come first in any case.
  static constexpr float most_gain = 1e29f;

  [[nodiscard]] static std::uint64_t name_of(const TreePlace& place) {
    return (static_cast<std::uint64_t>(place.y) << 32) | static_cast<std::uint64_t>(place.x);
  }
  void place(std::uint32_t leaf, float priority);
  void take_lagging(std::size_t size);
  [[nodiscard]] float behind(std::uint32_t leaf) const;
  void take(std::uint32_t leaf);
  void ask();
  void add_request(std::uint32_t leaf);
  void repair(std::uint32_t leaf);
  void take_own(std::uint32_t leaf, const float* values);
  void take_from_others();
  void advance(std::uint32_t leaf, bool news);
  void reserve_notes();
  void note(std::uint32_t leaf);
  void end_of(std::uint32_t leaf);
  void begin_end_of(std::uint32_t leaf);
  void reserve_split();
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
  BlockQueue behind_;  // those of queue_, the one first that has the fewest samples for its area
  double area_ = 0;    // of the blocks that may be sampled, in blocks of 8 x 8 pixels
  std::optional<PixelCounts> pixels_;  // of choose()
  std::uint64_t frame_;                // the seed, mixed
  std::size_t leaves_;
  double scales_ = 0;  // of all blocks
  std::vector<Request> wave_;
  std::vector<std::uint32_t> owners_;  // of its positions
  struct Border {
    std::uint64_t name = 0;
    std::size_t number = 0;  // in `chosen_`
  };
  std::vector<Border> borders_;         // positions on borders
  std::vector<std::uint32_t> chosen_;   // leaves, some of which ask for nothing of their own
  std::vector<std::uint32_t> touched_;  // leaves that have taken in something
  std::vector<std::uint32_t> ripe_;     // leaves that may have to be split
  std::vector<bool> is_touched_;
  std::vector<float> factors_;  // on priorities, of each block; none: 1
  std::vector<float> told_;     // the scale of each node that others know of
  std::vector<float> values_;
  /// How far take_in() has come: where it is to go on when memory has run out.
  struct Taking {
    std::size_t sample = 0;                  // of the wave
    bool own = false;                        // its leaf has it
    std::array<std::uint32_t, 4> others{};   // leaves that may have come to know their next one
    std::size_t count = 0, other = 0;        // of these; which of them is next
    std::size_t ripe = 0;                    // in `ripe_`
    std::array<std::uint32_t, 4> growing{};  // leaves that have become able to take in more
    std::size_t growing_count = 0, grown = 0;
  };
  Taking taking_;
  std::vector<double> sums_;  // of the usable values of each channel
  std::vector<std::uint64_t> usable_;
  TreeStats stats_;
};

}  // namespace freqsynth

#include "freqsynth/engine/tree_sampler.inl"
