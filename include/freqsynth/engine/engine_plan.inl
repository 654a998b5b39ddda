// SPDX-License-Identifier: MIT
// What the chosen blocks ask for, and where each sample of each visit comes from: all is known
// before the first value comes.
#pragma once

#include "freqsynth/basis/mix_bits.h"

namespace freqsynth {

/// Completes the plan whose blocks are chosen, and makes the slots of the wave.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::plan_visits() {
  const std::size_t chosen = plan_.size();
  for (std::size_t i = 0; i < chosen; ++i) {
    const Visit visit = plan_.visits()[i];
    lengthen(visit.block);
    // Blocks beside it whose next sample is one of these take it in as well.
    for (std::uint32_t index = visit.first; index < visit.asked_end(); ++index) {
      grid_.visit_sharing(visit.block, position(index), [&](std::uint32_t other, std::uint32_t at) {
        const std::uint32_t end =
            plan_.contains(other) ? plan_.of(other).end() : blocks_.samples(other);
        if (at == end) lengthen(other);
      });
    }
  }
  plan_.sort();
  for (Visit& visit : plan_.visits()) ask(visit);
}

/// Index after the last sample that a block has or is chosen for.
template <Refiner R, BlockMeasure<R> M>
std::uint32_t Engine<R, M>::asked_end(std::uint32_t block) const {
  return plan_.contains(block) ? plan_.of(block).asked_end() : blocks_.samples(block);
}

/// Lets a block go on with those of its next samples that are known, or will be.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::lengthen(std::uint32_t block) {
  std::uint32_t end = plan_.contains(block) ? plan_.of(block).end() : blocks_.samples(block);
  for (; end < blocks_.most_samples(); ++end) {
    bool known = false;
    grid_.visit_sharing(block, position(end), [&](std::uint32_t other, std::uint32_t index) {
      known = known || index < asked_end(other);
    });
    if (!known) return;
    if (!plan_.contains(block)) plan_.add({.block = block, .first = end});
    ++plan_.of(block).count;
  }
}

/// Finds the sources of a visit. Those of blocks before it are known.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::ask(Visit& visit) {
  visit.begin = static_cast<std::uint32_t>(plan_.source_count());
  for (std::uint32_t index = visit.first; index < visit.end(); ++index) {
    plan_.add_source(source_of(visit.block, index));
  }
}

/// A point that several blocks take in is asked for by the first of them. Nothing is taken out of
/// the cache yet: until the wave is complete, all is as it was.
template <Refiner R, BlockMeasure<R> M>
ValueSource Engine<R, M>::source_of(std::uint32_t block, std::uint32_t index) {
  const SequencePosition& place = position(index);
  const auto slot = static_cast<std::uint32_t>(wave_.samples());
  if (place.side != BlockSide::interior) {
    const ValueSource* shared = nullptr;
    bool others = false, known = false;
    grid_.visit_sharing(block, place, [&](std::uint32_t other, std::uint32_t at) {
      others = true;
      known = known || at < blocks_.samples(other);
      if (other >= block || !plan_.contains(other)) return;
      const Visit& visit = plan_.of(other);
      if (at >= visit.first && at < visit.end()) shared = &plan_.source(visit, at);
    });
    if (shared != nullptr) return *shared;
    if (known) {
      known_.push_back({block, index});
      return {static_cast<std::uint32_t>(known_.size() - 1), true};
    }
    if (others) borders_.push_back(slot);
  }
  wave_.add({block, index});
  return {slot, false};
}

/// All of a request but its ordinal.
template <Refiner R, BlockMeasure<R> M>
Request Engine<R, M>::make_request(std::uint32_t slot) const {
  const Wave::Slot& asked = wave_.slot(slot);
  const SequencePosition& place = position(asked.index);
  const BlockGrid::Point point = grid_.point(asked.block, place);
  const std::size_t side =
      std::min(grid_.block_width(asked.block), grid_.block_height(asked.block));
  // Names take 53 bits.
  const bool again = asked.repeated != Wave::Slot::none;
  const std::uint64_t id =
      grid_.name(asked.block, asked.index, place) | (again ? std::uint64_t{1} << 63 : 0);
  return {.x = point.x,
          .y = point.y,
          .id = id,
          .spacing = place.spacing * static_cast<float>(side),
          .slot = slot,
          .seed = detail::mix_bits(id * detail::golden_step + frame_),
          .pixel = pixels_.pixel(point),
          .ordinal = 0,
          .thread = 0,
          .again = again};
}

}  // namespace freqsynth
