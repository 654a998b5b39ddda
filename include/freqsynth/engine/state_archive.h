// SPDX-License-Identifier: MIT
/// \file
/// What is saved of each part of an engine (archive.h has the form), and what a saved one must hold
/// to be taken. What follows from the rest is not saved.
///
/// Loading fills a part that is as new. Numbers that stand for places or sizes are made sure of;
/// others may be anything, as the host's values may.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/block_choice.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/channel_units.h"
#include "freqsynth/engine/edge_cache.h"
#include "freqsynth/engine/exploration.h"
#include "freqsynth/engine/noise_probes.h"
#include "freqsynth/engine/pixel_counts.h"
#include "freqsynth/engine/pixel_store.h"
#include "freqsynth/engine/signal_statistics.h"
#include "freqsynth/engine/steering.h"
#include "freqsynth/engine/wave.h"

namespace freqsynth {

/// \cond internal
/// Each member lists a part for an archive, to be saved or to be loaded.
struct StateArchive {
  template <class Archive, class Stats>
  static void stats(Archive& archive, Stats& stats) {
    archive.number(stats.samples);
    archive.number(stats.probes);
    archive.number(stats.differing_probes);
    archive.number(stats.absorbed);
    archive.number(stats.bad_samples);
    archive.number(stats.ignored_bad_samples);
    archive.number(stats.abandoned);
    archive.number(stats.waves);
  }

  template <class Archive, class Rule>
  static void stop(Archive& archive, Rule& rule) {
    archive.number(rule.samples_per_pixel);
    archive.number(rule.samples);
    archive.number(rule.seconds);
    archive.number(rule.target_rmse);
    archive.number(rule.aliasing_threshold);
    archive.count(rule.least_samples);
    for (const double one :
         {rule.samples_per_pixel, rule.seconds, rule.target_rmse, rule.aliasing_threshold}) {
      archive.check(!detail::is_nan(one) && one >= 0);
    }
  }

  template <class Archive, class Watch>
  static void errors(Archive& archive, Watch& watch) {
    archive.number(watch.next_);
    archive.number(watch.place_);
    archive.number(watch.last_);
    archive.number(watch.least_);
    for (const double one : {watch.last_, watch.least_}) {
      archive.check(!detail::is_nan(one) && one >= 0);
    }
  }

  template <class Archive, class Samples>
  static void bad_samples(Archive& archive, Samples& samples, std::size_t most) {
    archive.list(samples, most, [&](auto& one) {
      archive.number(one.x);
      archive.number(one.y);
      archive.number(one.id);
    });
  }

  /// All but the host's weights.
  template <class Archive, class Units>
  static void units(Archive& archive, Units& units) {
    for (std::size_t c = 0; c < units.exponents_.size(); ++c) {
      std::int32_t exponent = units.exponents_[c];
      bool known = units.limits_[c] != 0;
      archive.number(exponent);
      archive.number(known);
      archive.check(known ? exponent >= -126 && exponent <= 126 : exponent == 0);
      if constexpr (Archive::loading) {
        if (known) units.set(c, exponent);
      }
    }
    archive.array(units.far_);
    if constexpr (Archive::loading) units.weigh();
  }

  /// All but the units, and the states.
  template <class Archive, class Store>
  static void counts(Archive& archive, Store& blocks) {
    archive.array(blocks.counts_);
    archive.array(blocks.missing_);
    archive.array(blocks.negative_);
    for (const std::uint8_t one : blocks.negative_) archive.check(one <= 1);
    blocks_in_range(archive, blocks);
    gaps(archive, blocks.gaps_, blocks.counts_, blocks.negative_.size());
  }

  /// Those of blocks that have had samples.
  template <class Archive, class Store>
  static void states(Archive& archive, Store& blocks) {
    const std::size_t size = blocks.refiner_.state_size();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (blocks.counts_[b] == 0) continue;
      archive.array(std::span(blocks.states_.data() + b * blocks.stride_, size));
    }
  }

  template <class Archive, class Store>
  static void surprises(Archive& archive, Store& blocks) {
    auto& book = blocks.surprises_;
    archive.array(std::span(book.counts_));
    for (auto& levels : book.levels_) {
      for (auto& level : levels) {
        archive.number(level.sum);
        archive.number(level.most);
        archive.number(level.second);
      }
    }
  }

  /// Samples on borders that wait: of each edge those that one of its blocks has and the other one
  /// will take, which tells how many there are; of each corner its values, where they are known.
  template <class Archive, class Cache, class Store>
  static void edges(Archive& archive, Cache& cache, const BlockGrid& grid, const Store& blocks);
  /// No block's next sample may be one that is known.
  template <class Archive, class Store>
  static void check_next(Archive& archive, const BlockGrid& grid, const Store& blocks);
  /// The corners that a block will take and another one has are known.
  template <class Archive, class Cache, class Store>
  static void check_corners(Archive& archive, const Cache& cache, const BlockGrid& grid,
                            const Store& blocks);

  template <class Archive, class Signal>
  static void signal(Archive& archive, Signal& signal) {
    const auto range = [&](auto& one) {
      archive.array(std::span(one.high_));
      archive.array(std::span(one.low_));
    };
    for (auto& sums : signal.sums_) {
      archive.number(sums.values);
      archive.number(sums.squares);
      archive.number(sums.count);
    }
    for (auto& one : signal.corner_ranges_) range(one);
    for (auto& one : signal.ranges_) range(one);
    archive.array(signal.settled_variances_);
    archive.array(signal.mean_squares_);
    archive.number(signal.settled_);
  }

  /// On the priorities of all blocks.
  template <class Archive, class Factors>
  static void factors(Archive& archive, Factors& factors) {
    archive.array(factors);
    for (const float factor : factors) {
      archive.check(detail::is_finite(factor) && factor >= 0 && factor <= 1e6f);
    }
  }

  /// Blocks that are full must be out of the queue.
  template <class Archive, class Choice, class Store>
  static void choice(Archive& archive, Choice& choice, const Store& blocks) {
    factors(archive, choice.factors_);
    for (std::size_t b = 0; b < choice.queue_.size(); ++b) {
      float priority = choice.queue_.priority(b);
      archive.number(priority);
      archive.check(detail::is_finite(priority) &&
                    (priority == BlockQueue::absent || !blocks.full(b)));
      if constexpr (Archive::loading) choice.queue_.update(b, priority);
    }
    measure(archive, choice.measure_);
  }

  template <class Archive, class Measure>
  static void measure(Archive& archive, Measure& measure) {
    if constexpr (requires { measure.steering_; }) steering(archive, measure.steering_);
    if constexpr (requires { measure.noisy_; }) archive.number(measure.noisy_);
    if constexpr (requires { measure.variations_; }) archive.array(measure.variations_);
    if constexpr (requires { measure.book_; }) {
      archive.array(measure.book_.residuals_);
      archive.array(measure.book_.told_);
      archive.number(measure.book_.sum_);
    }
  }

  template <class Archive, class S>
  static void steering(Archive& archive, S& steering) {
    archive.number(steering.noisy_);
    archive.number(steering.settled_);
    archive.array(steering.slopes_);
    archive.array(steering.levels_);
    archive.number(steering.variance_);
  }

  template <class Archive, class Counts>
  static void pixels(Archive& archive, Counts& counts) {
    bool wide = !counts.wide_.empty();
    archive.number(wide);
    if constexpr (Archive::loading) {
      if (wide) {
        counts.wide_.resize(counts.narrow_.size());
        counts.narrow_ = {};
      }
    }
    archive.array(counts.wide_);
    archive.array(counts.narrow_);
    if constexpr (Archive::loading) {
      counts.largest_ = 0;
      for (const auto one : counts.narrow_) {
        counts.largest_ = std::max<std::size_t>(counts.largest_, one);
      }
    }
  }

  template <class Archive, class Store>
  static void apart(Archive& archive, Store& apart) {
    for (auto& kept : apart.kept_) {
      archive.number(kept.value);
      archive.number(kept.count_or_distance);
      // Neither is below 0 or NaN.
      archive.check(kept.count_or_distance >= 0);
    }
  }

  template <class Archive, class E>
  static void exploration(Archive& archive, E& exploration) {
    archive.number(exploration.least_);
    // A number of samples.
    archive.check(exploration.least_ >= 0 && exploration.least_ < 1e19);
    archive.list(exploration.lagging_, exploration.any() ? exploration.blocks_ : 0);
    archive.count(exploration.next_);
    archive.check(exploration.next_ <= exploration.lagging_.size());
    for (const std::uint32_t block : exploration.lagging_) {
      archive.check(block < exploration.blocks_);
    }
  }

  /// \param before  samples that are asked for or have come
  template <class Archive, class Probes>
  static void probes(Archive& archive, Probes& probes, std::uint64_t before) {
    archive.number(probes.number_);
    if constexpr (Archive::loading) {
      // That of root `before` or the one after it.
      constexpr std::uint64_t most = std::uint64_t{1} << 32;
      archive.check(probes.number_ >= 2 && probes.number_ < most);
      probes.next_ = probes.place(probes.number_);
      archive.check(probes.next_ >= before &&
                    (probes.number_ == 2 || probes.place(probes.number_ - 1) < before));
    }
  }

  /// All but what its slots ask for, which are there. What is owed waits again once it is loaded.
  template <class Archive, class W>
  static void wave(Archive& archive, W& wave);

 private:
  template <class Archive, class Store>
  static void blocks_in_range(Archive& archive, Store& blocks);
  template <class Archive, class Log>
  static void gaps(Archive& archive, Log& log, std::span<const std::uint32_t> counts,
                   std::size_t channels);
  /// The positions on one side of a block, as far as blocks have got.
  struct Side {
    std::vector<std::uint32_t> counts;    // of those among the first n of the sequence
    std::vector<std::uint32_t> partners;  // of each, in order
  };
  using Sides = std::array<Side, 4>;
  static const Side& side(const Sides& sides, BlockSide which) {
    return sides[static_cast<std::size_t>(which) - static_cast<std::size_t>(BlockSide::left)];
  }
  template <class List>
  static Sides sides_of(const List& list, std::size_t longest);
  template <class Archive, class Cache, class Edge>
  static void edge(Archive& archive, Cache& cache, Edge& edge, std::uint32_t first,
                   std::uint32_t count);
};
/// \endcond

}  // namespace freqsynth

#include "freqsynth/engine/state_archive.inl"
