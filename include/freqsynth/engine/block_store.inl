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
    bool plain = !gaps_.any(block);
    float* out = values_.data();
    for (std::size_t i = 0; i < together; ++i, out += factors_.size()) {
      plain = to_units(values(first + i), out) && plain;
    }
    if (plain) [[likely]] {
      absorb_run(block, values_.data(), part, true);
    } else {
      for (std::size_t i = 0; i < together; ++i) {
        const float* one = values_.data() + i * factors_.size();
        note_gaps(block, counts_[block], one);
        absorb_run(block, one, part.subspan(i, 1), false);
      }
    }
  }
}

/// \return whether all values are usable in the host's unit, and so in any
template <Refiner R>
bool BlockStore<R>::to_units(const float* values, float* out) {
  // Seen as bits, what is usable and not new is not more than some number.
  constexpr auto most = std::bit_cast<std::uint32_t>(max_sample_magnitude);
  const float* const factors = factors_.data();
  const std::uint32_t* const looks = looks_.data();
  const std::size_t channels = factors_.size();
  std::uint32_t news = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const float value = values[c];
    out[c] = value * factors[c];
    news |= (std::bit_cast<std::uint32_t>(value) & looks[c]) > most ? 1u : 0u;
  }
  return news == 0 ? true : note_values(values, out);
}

/// The same where a value is not usable, or a channel's first one below zero.
template <Refiner R>
bool BlockStore<R>::note_values(const float* values, float* out) {
  bool bad = false;
  for (std::size_t c = 0; c < factors_.size(); ++c) {
    const bool usable = is_usable_sample(values[c]);
    out[c] = usable ? values[c] * factors_[c] : std::bit_cast<float>(0x7fc00000u);
    bad = bad || !usable;
    if (usable && values[c] < 0) {
      negative_[c] = 1;
      looks_[c] = without_sign;
    }
  }
  return !bad;
}

template <Refiner R>
void BlockStore<R>::absorb_run(std::size_t block, const float* values, std::span<float> changes,
                               bool usable) {
  float* state = states_.data() + block * stride_;
  remember(block);
  bool together = false;
  if constexpr (RefinesRuns<R>) {
    together = usable;
    if (together) refiner_.absorb(state, counts_[block], values, changes);
  }
  for (std::size_t i = 0; !together && i < changes.size(); ++i) {
    changes[i] = refiner_.absorb(state, counts_[block] + i, values + i * factors_.size());
  }
  std::uint32_t& count = counts_[block];
  const std::uint32_t before = count;
  if (count == 0) --untouched_;
  count += static_cast<std::uint32_t>(changes.size());
  note_surprises(block, before);
  largest_ = std::max<std::size_t>(largest_, count);
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

/// Before a block takes in samples.
template <Refiner R>
void BlockStore<R>::remember(std::size_t block) {
  for (std::size_t c = 0; c < before_.size(); ++c) before_[c] = squares(block, c);
}

/// And afterwards. \param before  samples that it had had
template <Refiner R>
void BlockStore<R>::note_surprises(std::size_t block, std::size_t before) {
  const std::size_t now = counts_[block];
  surprises_.count(before, now - before);
  for (std::size_t c = 0; c < before_.size(); ++c) {
    const float left = squares(block, c);
    if (!(left > 2 * before_[c])) [[likely]]
      continue;
    surprises_.note(c, {before, before_[c], refiner_.freedom(before)},
                    {now, left, refiner_.freedom(now)});
  }
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
