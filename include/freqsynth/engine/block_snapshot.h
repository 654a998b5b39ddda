// SPDX-License-Identifier: MIT
/// \file
/// The blocks of an image as they were at one moment, to be read while sampling goes on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/state_keeper.h"
#include "freqsynth/engine/surprise_book.h"
#include "freqsynth/refine/gap_log.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// All that images are made of. What is small is copied at once; a block's state when it is read.
template <Refiner R>
class BlockSnapshot {
 public:
  /// \param store   may change afterwards only if it is watched by `keeper`, see BlockStore::watch()
  /// \param keeper  null: the store stays as it is
  explicit BlockSnapshot(const BlockStore<R>& store, detail::StateKeeper* keeper = nullptr)
      : store_(store),
        keeper_(keeper),
        refiner_(store.refiner()),
        counts_(store.counts().begin(), store.counts().end()),
        gaps_(store.gap_log()),
        surprises_(store.surprises()) {
    for (std::size_t c = 0; c < refiner_.channels(); ++c) {
      exponents_.push_back(store.exponent(c));
      negative_.push_back(store.any_negative(c) ? 1 : 0);
    }
  }

  /// The refiner of all blocks, with the weights of that moment.
  [[nodiscard]] const R& refiner() const { return refiner_; }
  /// Values per sample.
  [[nodiscard]] std::size_t channels() const { return exponents_.size(); }
  /// Number of blocks.
  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  /// Samples that blocks had.
  [[nodiscard]] std::span<const std::uint32_t> counts() const { return counts_; }
  /// Samples that a block had.
  [[nodiscard]] std::uint32_t samples(std::size_t block) const { return counts_[block]; }
  /// Binary logarithm of a channel's unit.
  [[nodiscard]] int exponent(std::size_t channel) const { return exponents_[channel]; }
  /// Whether a usable value of a channel was below zero.
  [[nodiscard]] bool any_negative(std::size_t channel) const { return negative_[channel] != 0; }

  /// How often blocks had turned out to be other than they seemed, see BlockStore.
  [[nodiscard]] const SurpriseBook& surprises() const { return surprises_; }

  /// Floats of a state, whole cache lines.
  [[nodiscard]] std::size_t state_size() const { return store_.state_size(); }
  /// Copies the state of a block.
  /// \param reads  how often it will be read in all, at most 9
  void read(std::size_t block, float* state, unsigned reads = 1) const {
    const float* from = store_.state(block);
    if (keeper_) {
      keeper_->read(block, from, state, reads);
    } else {
      std::copy_n(from, state_size(), state);
    }
  }

  // What the refiner says of a block with that state.
  /// The coefficients alone.
  void coefficients(std::size_t block, const float* state, std::size_t channel,
                    std::span<float, max_terms> out) const {
    refiner_.coefficients(state, counts_[block], channel, out);
  }
  /// See Refiner.
  [[nodiscard]] BlockFit fit(std::size_t block, const float* state, std::size_t channel) const {
    return refiner_.fit(state, counts_[block], channel);
  }
  /// Sums of the samples that lie in each pixel and their spread, see BlockFit.
  struct OwnSamples {
    std::span<const float> sums;  ///< none: not known
    float spread;                 ///< of the channel's unit
  };
  /// Those of a channel.
  [[nodiscard]] OwnSamples own_samples(std::size_t block, const float* state,
                                       std::size_t channel) const {
    if constexpr (requires {
                    refiner_.own_sums(state, channel);
                    refiner_.spread(state, channel);
                  }) {
      return {refiner_.own_sums(state, channel), refiner_.spread(state, channel)};
    } else {
      const BlockFit fit = this->fit(block, state, channel);
      return {fit.own_sums, fit.spread};
    }
  }
  /// Whether any sample of a block had no usable value.
  [[nodiscard]] bool any_gaps(std::size_t block) const { return gaps_.any(block); }
  /// Those of a channel, and what was absorbed in their place.
  [[nodiscard]] std::vector<Gap> gaps(std::size_t block, std::size_t channel) const {
    return gaps_.of(block, channel);
  }
  /// See BlockStore::fit_without().
  [[nodiscard]] BlockFit fit_without(std::size_t block, const float* state, std::size_t channel,
                                     std::span<const Gap> gaps) const {
    if constexpr (FillsGaps<R>) return refiner_.fit(state, counts_[block], channel, gaps);
    return fit(block, state, channel);
  }
  /// See BlockStore::fit_without_gaps().
  [[nodiscard]] BlockFit fit_without_gaps(std::size_t block, const float* state,
                                          std::size_t channel, std::vector<Gap>& gaps) const {
    if constexpr (FillsGaps<R>) {
      if (gaps_.any(block)) {
        gaps = gaps_.of(block, channel);
        return refiner_.fit(state, counts_[block], channel, gaps);
      }
    }
    return fit(block, state, channel);
  }

 private:
  const BlockStore<R>& store_;
  detail::StateKeeper* keeper_;
  R refiner_;
  std::vector<std::uint32_t> counts_;
  GapLog gaps_;
  SurpriseBook surprises_;
  std::vector<int> exponents_;
  std::vector<std::uint8_t> negative_;
};

}  // namespace freqsynth
