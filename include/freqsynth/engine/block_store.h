// SPDX-License-Identifier: MIT
/// \file
/// What is known of each block: its refiner's state and how many samples it has had.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/large_pages.h"
#include "freqsynth/engine/state_keeper.h"
#include "freqsynth/engine/surprise_book.h"
#include "freqsynth/refine/gap_log.h"
#include "freqsynth/refine/refiner.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// What a thread needs for itself that takes in samples of blocks while others take in those of
/// other blocks.
struct AbsorbRoom {
  std::vector<float> values;           ///< of some samples in the channels' units
  std::vector<std::uint8_t> negative;  ///< 1: a channel had a value below 0, see join()
};

/// The blocks of one image, all refined by the same refiner.
template <Refiner R>
class BlockStore {
 public:
  /// \param most_samples  samples that a block may have, at least 1
  BlockStore(R refiner, std::size_t blocks, std::size_t most_samples);

  /// The refiner of all blocks.
  [[nodiscard]] const R& refiner() const { return refiner_; }
  /// Number of blocks.
  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  /// Samples that a block has had. Its next one has this index in the sequence.
  [[nodiscard]] std::uint32_t samples(std::size_t block) const { return counts_[block]; }
  /// Whether a block may not have another sample.
  [[nodiscard]] bool full(std::size_t block) const { return counts_[block] >= most_samples_; }
  /// Samples that a block may have.
  [[nodiscard]] std::size_t most_samples() const { return most_samples_; }
  /// Number of blocks without a sample.
  [[nodiscard]] std::size_t untouched() const { return untouched_; }
  /// Samples of the block that has the most.
  [[nodiscard]] std::size_t largest() const { return largest_; }

  /// Changes the units that states are kept in, at first 1: each channel's is 2 to the power of its
  /// exponent, in -126..126. Values come in the host's unit; all that is said of a block is in
  /// these. `weights` are those of the channels in their new units.
  void use_units(std::span<const int> exponents, std::span<const float> weights);
  /// Binary logarithm of a channel's unit.
  [[nodiscard]] int exponent(std::size_t channel) const { return exponents_[channel]; }

  /// Takes in the next sample of a block that is not full. \return the refiner's measure of change.
  float absorb(std::size_t block, const float* values);
  /// Takes in the next samples of a block that has room for them, as many as there are `changes`,
  /// which receive the refiner's measure of each.
  /// \param values  values(i) points to those of the i-th of them, one per channel
  template <class Values>
  void absorb(std::size_t block, std::span<float> changes, Values&& values);
  /// Room for one thread that calls absorb_apart().
  [[nodiscard]] AbsorbRoom make_room() const {
    return {std::vector<float>(values_.size()), std::vector<std::uint8_t>(negative_.size())};
  }
  /// The same as absorb() in two steps, of which this one may run for several blocks at the same
  /// time. It does nothing, and absorb() is to be called later, where a value is missing, or was
  /// before, or there are too many samples.
  /// \param squares  room for two floats of each channel, for join()
  /// \return whether it is done
  template <class Values>
  bool absorb_apart(std::size_t block, std::span<float> changes, Values&& values, AbsorbRoom& room,
                    std::span<float> squares);
  /// The second step, block by block in an order that results depend on: tells what concerns all
  /// blocks. Between the two only the block itself knows of its samples.
  /// \param samples  that were taken in
  void join(std::size_t block, std::size_t samples, std::span<const float> squares);
  /// The same of a thread's room, in any order.
  void join(AbsorbRoom& room);
  /// Hints that a block will take in `count` samples from `index` on soon.
  void prefetch(std::size_t block, std::size_t index, std::size_t count) const {
    if constexpr (RefinesRuns<R>) {
      refiner_.prefetch(state(block), index, count);
    } else {
      for (std::size_t i = 0; i < count; ++i) refiner_.prefetch(state(block), index + i);
    }
  }

  // What the refiner says of a block; see the concept. Predictions in the place of values that are
  // not usable are no agreement: they are no degrees of freedom.
  /// See Refiner.
  [[nodiscard]] float freedom(std::size_t block) const { return refiner_.freedom(informed(block)); }
  /// See Refiner.
  [[nodiscard]] float residual(std::size_t block) const {
    const float residual = refiner_.residual(state(block), counts_[block]);
    return missing_[block] == 0 ? residual : residual * undiluted(block);
  }
  /// See Refiner.
  [[nodiscard]] float residual(std::size_t block, std::size_t channel) const {
    const float residual = refiner_.residual(state(block), counts_[block], channel);
    return missing_[block] == 0 ? residual : residual * undiluted(block);
  }
  /// See Refiner.
  void coefficients(std::size_t block, std::size_t channel, std::span<float, max_terms> out) const {
    refiner_.coefficients(state(block), counts_[block], channel, out);
  }
  /// See Refiner.
  [[nodiscard]] BlockFit fit(std::size_t block, std::size_t channel) const {
    return refiner_.fit(state(block), counts_[block], channel);
  }
  /// Whether some samples of a block had no usable value in this channel.
  [[nodiscard]] bool has_gaps(std::size_t block, std::size_t channel) const {
    return gaps_.any(block) && !gaps_.of(block, channel).empty();
  }
  /// Those samples, and what was absorbed in their place.
  [[nodiscard]] std::vector<Gap> gaps(std::size_t block, std::size_t channel) const {
    return gaps_.of(block, channel);
  }
  /// The fit without the samples in `gaps`, which it refers to, where the refiner can do without.
  [[nodiscard]] BlockFit fit_without(std::size_t block, std::size_t channel,
                                     std::span<const Gap> gaps) const {
    if constexpr (FillsGaps<R>) return refiner_.fit(state(block), counts_[block], channel, gaps);
    return fit(block, channel);
  }
  /// The fit without the samples that had no usable value in this channel. It refers to `gaps`,
  /// which receives them.
  [[nodiscard]] BlockFit fit_without_gaps(std::size_t block, std::size_t channel,
                                          std::vector<Gap>& gaps) const;
  /// Samples of a block that had a usable value in all channels that have a weight.
  [[nodiscard]] std::uint32_t informed(std::size_t block) const {
    return counts_[block] - missing_[block];
  }
  /// Probability that the next sample of a block is one of these (Laplace), 1 where all have been.
  [[nodiscard]] float usable_share(std::size_t block) const {
    if (missing_[block] == 0) return 1;
    return static_cast<float>(informed(block) + 1) / static_cast<float>(counts_[block] + 1);
  }
  /// Whether a usable value of a channel was below zero.
  [[nodiscard]] bool any_negative(std::size_t channel) const { return negative_[channel] != 0; }
  /// How often blocks turned out to be other than they seemed. In the units of the states.
  [[nodiscard]] const SurpriseBook& surprises() const { return surprises_; }
  /// Makes room, so that the next `more` calls of absorb() cannot fail.
  void reserve(std::size_t more) { gaps_.reserve(more * refiner_.channels()); }

  // What a BlockSnapshot is made of.
  /// Floats from a state to the next.
  [[nodiscard]] std::size_t state_size() const { return stride_; }
  /// The state of a block.
  [[nodiscard]] const float* state(std::size_t block) const {
    return states_.data() + block * stride_;
  }
  /// Samples of all blocks.
  [[nodiscard]] std::span<const std::uint32_t> counts() const { return counts_; }
  /// The gaps of all blocks.
  [[nodiscard]] const GapLog& gap_log() const { return gaps_; }
  /// From now on every state is shown to `keeper` before it changes; null: to nobody.
  void watch(detail::StateKeeper* keeper) const { keeper_ = keeper; }

 private:
  friend struct StateArchive;

  /// To be called before a state changes, wherever that is.
  void keep(std::size_t block) const {
    if (keeper_) [[unlikely]] {
      keeper_->keep(block, state(block));
    }
  }

  [[nodiscard]] float undiluted(std::size_t block) const {
    return refiner_.freedom(counts_[block]) / freedom(block);
  }
  bool to_units(const float* values, float* out, std::vector<std::uint8_t>& negative) const;
  void refine(std::size_t block, const float* values, std::span<float> changes);
  void absorb_run(std::size_t block, const float* values, std::span<float> changes);
  void note_gaps(std::size_t block, std::size_t index, const float* values);
  [[nodiscard]] float squares(std::size_t block, std::size_t channel) const;
  void squares(std::size_t block, std::span<float> out) const;

  R refiner_;
  std::size_t most_samples_;
  std::size_t stride_;  // whole cache lines
  detail::UnsetVector<float> states_;
  mutable detail::StateKeeper* keeper_ = nullptr;
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint32_t> missing_;  // of these, without a usable value where it counts
  GapLog gaps_;
  std::size_t untouched_;
  std::size_t largest_ = 0;
  std::vector<int> exponents_;
  std::vector<float> factors_;          // of a value: 1 / unit
  std::vector<std::uint8_t> negative_;  // 1: a channel's values are not all positive or 0
  std::vector<float> values_;           // of `most_together` samples in the channels' units
  SurpriseBook surprises_;
  std::vector<float> squares_;  // before and after some samples

  static constexpr std::size_t most_together = 16;
};

// ------------------------------------------------------------------------------------ definitions

template <Refiner R>
BlockStore<R>::BlockStore(R refiner, std::size_t blocks, std::size_t most_samples)
    : refiner_(std::move(refiner)),
      most_samples_(most_samples),
      counts_(blocks),
      missing_(blocks),
      gaps_(blocks),
      surprises_(refiner_.channels()),
      squares_(2 * refiner_.channels()) {
  exponents_.assign(refiner_.channels(), 0);
  factors_.assign(refiner_.channels(), 1.0f);
  negative_.resize(refiner_.channels());
  values_.resize(most_together * refiner_.channels());
  constexpr std::size_t line = detail::alignment / sizeof(float);
  stride_ = (refiner_.state_size() + line - 1) / line * line;
  states_.resize(blocks * stride_);
  untouched_ = blocks;
  for (std::size_t b = 0; b < blocks; ++b) {
    float* state = states_.data() + b * stride_;
    refiner_.reset(state);
    std::fill(state + refiner_.state_size(), state + stride_, 0.0f);
  }
}

template <Refiner R>
void BlockStore<R>::use_units(std::span<const int> exponents, std::span<const float> weights) {
  refiner_.weigh(weights);
  for (std::size_t c = 0; c < exponents_.size(); ++c) {
    const int difference = exponents_[c] - exponents[c];
    if (difference == 0) continue;
    exponents_[c] = exponents[c];
    factors_[c] = std::ldexp(1.0f, -exponents[c]);
    gaps_.rescale(c, std::ldexp(1.0f, difference));
    surprises_.rescale(c, difference);
    for (std::size_t b = 0; b < size(); ++b) {
      if (counts_[b] == 0) continue;
      keep(b);
      refiner_.rescale(states_.data() + b * stride_, c, difference);
    }
  }
}

template <Refiner R>
BlockFit BlockStore<R>::fit_without_gaps(std::size_t block, std::size_t channel,
                                         std::vector<Gap>& gaps) const {
  if constexpr (FillsGaps<R>) {
    if (gaps_.any(block)) {
      gaps = gaps_.of(block, channel);
      return refiner_.fit(state(block), counts_[block], channel, gaps);
    }
  }
  return fit(block, channel);
}

}  // namespace freqsynth

#include "freqsynth/engine/block_store.inl"
