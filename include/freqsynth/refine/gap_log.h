// SPDX-License-Identifier: MIT
/// \file
/// What is known of samples that had no usable value: which they were, and what took their place.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// The gaps of all blocks of an image. A block without any takes four bytes.
class GapLog {
 public:
  /// No gaps.
  explicit GapLog(std::size_t blocks) : heads_(blocks, none) {}

  /// Makes room, so that the next `more` calls of add() cannot fail.
  void reserve(std::size_t more) {
    const std::size_t needed = entries_.size() + more;
    if (needed > entries_.capacity()) entries_.reserve(std::max(needed, 2 * entries_.capacity()));
  }

  /// Whether a block has gaps.
  [[nodiscard]] bool any(std::size_t block) const { return heads_[block] != none; }
  /// Notes a gap of a channel of a block. A value that is not a number stands for one that was not
  /// known then, see start().
  void add(std::size_t block, std::size_t channel, std::size_t sample, float value) {
    entries_.push_back({{static_cast<std::uint32_t>(sample), value},
                        static_cast<std::uint32_t>(channel),
                        heads_[block]});
    heads_[block] = static_cast<std::uint32_t>(entries_.size() - 1);
  }
  /// The gaps that a channel of a block began with have this value.
  void start(std::size_t block, std::size_t channel, float value);
  /// Multiplies the values of a channel by a factor.
  void rescale(std::size_t channel, float factor);

  /// The gaps of a channel of a block, the last one first.
  [[nodiscard]] std::vector<Gap> of(std::size_t block, std::size_t channel) const;

 private:
  friend struct StateArchive;

  static constexpr std::uint32_t none = 0xffffffffu;
  struct Entry {
    Gap gap;
    std::uint32_t channel;
    std::uint32_t next;  // of the same block, an earlier one
  };

  std::vector<std::uint32_t> heads_;
  std::vector<Entry> entries_;
};

// ------------------------------------------------------------------------------------ definitions

inline void GapLog::start(std::size_t block, std::size_t channel, float value) {
  for (std::uint32_t at = heads_[block]; at != none; at = entries_[at].next) {
    if (entries_[at].channel == channel) entries_[at].gap.value = value;
  }
}

inline void GapLog::rescale(std::size_t channel, float factor) {
  for (Entry& entry : entries_) {
    if (entry.channel == channel) entry.gap.value *= factor;
  }
}

inline std::vector<Gap> GapLog::of(std::size_t block, std::size_t channel) const {
  std::vector<Gap> gaps;
  for (std::uint32_t at = heads_[block]; at != none; at = entries_[at].next) {
    const Entry& entry = entries_[at];
    if (entry.channel == channel && !detail::is_nan(entry.gap.value)) gaps.push_back(entry.gap);
  }
  return gaps;
}

}  // namespace freqsynth
