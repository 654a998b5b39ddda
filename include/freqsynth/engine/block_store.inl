// SPDX-License-Identifier: MIT
// How blocks take in samples.
#pragma once

#include "freqsynth/engine/block_store.h"

namespace freqsynth {

template <Refiner R>
float BlockStore<R>::absorb(std::size_t block, const float* values) {
  float change = 0;
  absorb(block, std::span(&change, 1), [values](std::size_t) { return values; });
  return change;
}

template <Refiner R>
template <class Values>
void BlockStore<R>::absorb(std::size_t block, std::span<float> changes, Values&& values) {
  FREQSYNTH_ASSERT(samples(block) + changes.size() <= most_samples_);
  keep(block);
  for (std::size_t first = 0; first < changes.size(); first += most_together) {
    const std::size_t together = std::min(changes.size() - first, most_together);
    const std::span<float> part = changes.subspan(first, together);
    bool bad = gaps_.any(block);
    for (std::size_t i = 0; i < together; ++i) {
      bad = to_units(values(first + i), values_.data() + i * factors_.size(), negative_) || bad;
    }
    if (!bad) {
      absorb_run(block, values_.data(), part);
    } else {
      for (std::size_t i = 0; i < together; ++i) {
        const float* one = values_.data() + i * factors_.size();
        note_gaps(block, counts_[block], one);
        absorb_run(block, one, part.subspan(i, 1));
      }
    }
  }
}

/// \return whether one of the values is not usable in the host's unit, and so not in any
template <Refiner R>
bool BlockStore<R>::to_units(const float* values, float* out,
                             std::vector<std::uint8_t>& negative) const {
  bool bad = false;
  for (std::size_t c = 0; c < factors_.size(); ++c) {
    const bool usable = is_usable_sample(values[c]);
    out[c] = usable ? values[c] * factors_[c] : std::bit_cast<float>(0x7fc00000u);
    bad = bad || !usable;
    if (usable && values[c] < 0) negative[c] = 1;
  }
  return bad;
}

template <Refiner R>
template <class Values>
bool BlockStore<R>::absorb_apart(std::size_t block, std::span<float> changes, Values&& values,
                                 AbsorbRoom& room, std::span<float> squares) {
  FREQSYNTH_ASSERT(samples(block) + changes.size() <= most_samples_);
  if (changes.size() > most_together || gaps_.any(block)) return false;
  bool bad = false;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    float* out = room.values.data() + i * factors_.size();
    bad = to_units(values(i), out, room.negative) || bad;
  }
  if (bad) return false;
  keep(block);
  this->squares(block, squares.first(factors_.size()));
  refine(block, room.values.data(), changes);
  this->squares(block, squares.subspan(factors_.size()));
  return true;
}

template <Refiner R>
void BlockStore<R>::join(AbsorbRoom& room) {
  for (std::size_t c = 0; c < negative_.size(); ++c) {
    negative_[c] = static_cast<std::uint8_t>(negative_[c] | room.negative[c]);
    room.negative[c] = 0;
  }
}

/// Touches nothing but the block.
template <Refiner R>
void BlockStore<R>::refine(std::size_t block, const float* values, std::span<float> changes) {
  float* state = states_.data() + block * stride_;
  if constexpr (RefinesRuns<R>) {
    refiner_.absorb(state, counts_[block], values, changes);
  } else {
    for (std::size_t i = 0; i < changes.size(); ++i) {
      changes[i] = refiner_.absorb(state, counts_[block] + i, values + i * factors_.size());
    }
  }
  counts_[block] += static_cast<std::uint32_t>(changes.size());
}

template <Refiner R>
void BlockStore<R>::absorb_run(std::size_t block, const float* values, std::span<float> changes) {
  const std::span<float> all = squares_;
  squares(block, all.first(factors_.size()));
  refine(block, values, changes);
  squares(block, all.subspan(factors_.size()));
  join(block, changes.size(), all);
}

/// Sum of the squares that a block's fit leaves over of a channel.
template <Refiner R>
float BlockStore<R>::squares(std::size_t block, std::size_t channel) const {
  if constexpr (requires { refiner_.squared_residuals(state(block), channel); }) {
    return refiner_.squared_residuals(state(block), channel);
  } else {
    return refiner_.residual(state(block), counts_[block], channel) *
           refiner_.freedom(counts_[block]);
  }
}

/// The same of all channels.
template <Refiner R>
void BlockStore<R>::squares(std::size_t block, std::span<float> out) const {
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = squares(block, c);
}

template <Refiner R>
void BlockStore<R>::join(std::size_t block, std::size_t samples, std::span<const float> squares) {
  const std::size_t now = counts_[block];
  const std::size_t before = now - samples;
  const std::size_t channels = factors_.size();
  if (before == 0) --untouched_;
  surprises_.count(before, samples);
  for (std::size_t c = 0; c < channels; ++c) {
    const float left = squares[channels + c];
    if (!(left > 2 * squares[c])) [[likely]]
      continue;
    surprises_.note(c, {before, squares[c], refiner_.freedom(before)},
                    {now, left, refiner_.freedom(now)});
  }
  largest_ = std::max<std::size_t>(largest_, now);
}

/// Before a block takes in a sample.
template <Refiner R>
void BlockStore<R>::note_gaps(std::size_t block, std::size_t index, const float* values) {
  if constexpr (FillsGaps<R>) {
    const std::span<const float> weights = refiner_.weights();
    bool missing = false;
    for (std::size_t c = 0; c < factors_.size(); ++c) {
      const bool usable = is_usable_sample(values[c]);
      missing = missing || (!usable && weights[c] > 0);
      const float prediction = refiner_.prediction(state(block), index, c);
      if (!usable) gaps_.add(block, c, index, prediction);
      if (usable && detail::is_nan(prediction)) gaps_.start(block, c, values[c]);
    }
    missing_[block] += missing ? 1 : 0;
  }
}

}  // namespace freqsynth
