// SPDX-License-Identifier: MIT
/// \file
/// A wave: positions that were chosen together, and the values that have come for them.
///
/// Every slot of a wave is waiting to be handed out, owed by the host, or delivered, for good or
/// abandoned. The engine takes the values in when all are delivered, in the order of the slots, so
/// that it does not matter in which order they came.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The wave that is under way. Nothing but reserve() allocates.
class Wave {
 public:
  /// The position that a slot asks for: the next one of a block, or that of another slot once more.
  struct Slot {
    static constexpr std::uint32_t no_ordinal = 0xffffffffu;  ///< not handed out yet
    static constexpr std::uint32_t none = 0xffffffffu;        ///< no other slot

    std::uint32_t block = 0;             ///< that asks
    std::uint32_t index = 0;             ///< in the block's sequence
    std::uint32_t ordinal = no_ordinal;  ///< in its pixel
    std::uint64_t id = 0;                ///< of the request, once handed out
    std::uint32_t repeated = none;       ///< the slot whose position it asks for once more
  };

  /// Empty, and without room.
  /// \param channels  values of a slot
  /// \param apart     more values of a slot, which come after these, are kept apart
  explicit Wave(std::size_t channels, std::size_t apart = 0) : channels_(channels), apart_(apart) {}

  /// Makes room for `most` slots, and for the values of `known` samples that are known before.
  void reserve(std::size_t most, std::size_t known = 0);
  /// Adds a slot, for which there is room. It repeats none.
  void add(const Slot& slot);
  /// Adds a slot that asks for the position of another one once more. No slot is added then but
  /// such ones.
  void repeat(std::uint32_t slot);

  /// Number of slots that repeat none: the first ones.
  [[nodiscard]] std::size_t samples() const { return samples_; }
  /// Number of all slots.
  [[nodiscard]] std::size_t size() const { return slots_.size(); }
  /// Whether there is no slot, and so no wave.
  [[nodiscard]] bool empty() const { return slots_.empty(); }
  /// What slot number `slot` asks for.
  [[nodiscard]] const Slot& slot(std::size_t slot) const { return slots_[slot]; }
  /// The same, to complete it.
  [[nodiscard]] Slot& slot(std::size_t slot) { return slots_[slot]; }

  /// Slots that wait to be handed out.
  [[nodiscard]] std::size_t waiting_count() const {
    return slots_.size() - next_ + returned_.size();
  }
  /// Whether one does.
  [[nodiscard]] bool waiting() const { return next_ < slots_.size() || !returned_.empty(); }
  /// Hands out a slot that waits, which is owed from then on; those that came back go before new
  /// ones.
  std::uint32_t hand_out();
  /// Whether a slot exists, was handed out, and is neither claimed nor delivered.
  [[nodiscard]] bool owed(std::size_t slot) const {
    return slot < slots_.size() && states_[slot] == State::owed;
  }
  // The host answers in two steps, so that an answer is taken as a whole or not at all: claim all
  // slots of it, which makes a second mention of a slot a fault; then deliver, abandon or recall
  // each, or let go of them.
  /// Claims a slot that is owed.
  void claim(std::uint32_t slot);
  /// A claimed slot is owed again.
  void let_go(std::uint32_t slot) { states_[slot] = State::owed; }
  /// Stores all values of a claimed slot.
  void deliver(std::uint32_t slot, const float* values);
  /// A claimed slot is delivered without a value: all are NaN.
  void abandon(std::uint32_t slot);
  /// Whether a slot was delivered so.
  [[nodiscard]] bool abandoned(std::size_t slot) const { return states_[slot] == State::abandoned; }
  /// Lets a claimed slot wait again.
  void recall(std::uint32_t slot);

  /// Number of slots whose values are there.
  [[nodiscard]] std::size_t delivered() const { return delivered_; }
  /// The same of those that repeat none.
  [[nodiscard]] std::size_t delivered_samples() const { return delivered_samples_; }
  /// Whether all values are there.
  [[nodiscard]] bool complete() const { return !empty() && delivered_ == slots_.size(); }
  /// The values of a slot that was delivered, one per channel.
  [[nodiscard]] const float* values(std::size_t slot) const {
    return values_.data() + slot * channels_;
  }

  /// Its other values.
  [[nodiscard]] const float* apart(std::size_t slot) const {
    return apart_values_.data() + slot * apart_;
  }

  /// Those of the slots of a complete wave that repeat none, `channels` for each.
  [[nodiscard]] std::span<float> values() { return {values_.data(), samples() * channels_}; }
  /// The values of a slot that was delivered, to change them.
  [[nodiscard]] float* values(std::size_t slot) { return values_.data() + slot * channels_; }

  /// Keeps a copy of the values of a sample that was known before the wave; there is room for it.
  void keep_known(const float* values);
  /// Those of the `number`-th such sample, counted from 0.
  [[nodiscard]] const float* known(std::size_t number) const {
    return known_.data() + number * channels_;
  }

  /// Ends the wave; its memory stays.
  void clear();

 private:
  friend struct StateArchive;

  enum class State : std::uint8_t { waiting, owed, claimed, delivered, abandoned };

  void count(std::uint32_t slot) {
    ++delivered_;
    delivered_samples_ += slot < samples_ ? 1 : 0;
  }

  std::size_t channels_, apart_;
  std::vector<Slot> slots_;
  std::vector<State> states_;
  std::vector<float> values_, apart_values_, known_;
  std::vector<std::uint32_t> returned_;  // slots that wait again
  std::size_t next_ = 0;                 // first slot that was never handed out
  std::size_t samples_ = 0;
  std::size_t delivered_ = 0, delivered_samples_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

inline void Wave::reserve(std::size_t most, std::size_t known) {
  if (known * channels_ > known_.capacity()) {
    known_.reserve(std::max(known * channels_, 2 * known_.capacity()));
  }
  slots_.reserve(most);
  states_.reserve(most);
  returned_.reserve(most);
  if (values_.size() < most * channels_) values_.resize(most * channels_);
  if (apart_values_.size() < most * apart_) apart_values_.resize(most * apart_);
}

inline void Wave::add(const Slot& slot) {
  FREQSYNTH_ASSERT(slots_.size() < slots_.capacity());
  FREQSYNTH_ASSERT(slots_.size() == samples_ && slot.repeated == Slot::none);
  slots_.push_back(slot);
  states_.push_back(State::waiting);
  ++samples_;
}

inline void Wave::repeat(std::uint32_t slot) {
  FREQSYNTH_ASSERT(slots_.size() < slots_.capacity() && slot < samples_);
  slots_.push_back({.block = slots_[slot].block, .index = slots_[slot].index, .repeated = slot});
  states_.push_back(State::waiting);
}

inline std::uint32_t Wave::hand_out() {
  FREQSYNTH_ASSERT(waiting());
  std::uint32_t slot = static_cast<std::uint32_t>(next_);
  if (returned_.empty()) {
    ++next_;
  } else {
    slot = returned_.back();
    returned_.pop_back();
  }
  states_[slot] = State::owed;
  return slot;
}

inline void Wave::claim(std::uint32_t slot) {
  FREQSYNTH_ASSERT(owed(slot));
  states_[slot] = State::claimed;
}

inline void Wave::recall(std::uint32_t slot) {
  FREQSYNTH_ASSERT(states_[slot] == State::claimed);
  states_[slot] = State::waiting;
  returned_.push_back(slot);
}

inline void Wave::deliver(std::uint32_t slot, const float* values) {
  FREQSYNTH_ASSERT(states_[slot] == State::claimed);
  states_[slot] = State::delivered;
  std::copy_n(values, channels_, values_.data() + slot * channels_);
  std::copy_n(values + channels_, apart_, apart_values_.data() + slot * apart_);
  count(slot);
}

inline void Wave::abandon(std::uint32_t slot) {
  FREQSYNTH_ASSERT(states_[slot] == State::claimed);
  states_[slot] = State::abandoned;
  // A NaN by its bits, which no compiler takes for impossible.
  const auto none = std::bit_cast<float>(0x7fc00000u);
  std::fill_n(values_.data() + slot * channels_, channels_, none);
  std::fill_n(apart_values_.data() + slot * apart_, apart_, none);
  count(slot);
}

inline void Wave::keep_known(const float* values) {
  FREQSYNTH_ASSERT(known_.size() + channels_ <= known_.capacity());
  known_.insert(known_.end(), values, values + channels_);
}

inline void Wave::clear() {
  known_.clear();
  slots_.clear();
  states_.clear();
  returned_.clear();
  next_ = samples_ = delivered_ = delivered_samples_ = 0;
}

}  // namespace freqsynth
