// SPDX-License-Identifier: MIT
// What is saved of an engine.
#pragma once

#include "freqsynth/engine/state_archive.h"

namespace freqsynth {

template <Refiner R, BlockMeasure<R> M>
template <class Archive, class Self>
void Engine<R, M>::list_parts(Archive& archive, Self& self) {
  archive.section("ENGN", [&] {
    std::size_t wave_size = self.wave_size_;
    archive.count(wave_size);
    archive.check(wave_size == self.wave_size_);
    Desk::list_desk(archive, self);
  });
  archive.section("UNIT", [&] { StateArchive::units(archive, self.units_); });
  if constexpr (Archive::loading) {
    self.blocks_.use_units(self.units_.exponents(), self.units_.weights());
  }
  archive.section("BLKS", [&] {
    StateArchive::counts(archive, self.blocks_);
    std::uint64_t absorbed = 0;
    for (const std::uint32_t count : self.blocks_.counts()) absorbed += count;
    archive.check(absorbed == self.stats_.absorbed);
  });
  archive.section("STAT", [&] {
    StateArchive::states(archive, self.blocks_);
    // The list grows as far as blocks have got; so not before the counts are known to be right.
    if constexpr (Archive::loading) StateArchive::check_next(archive, self.grid_, self.blocks_);
  });
  archive.section("SURP", [&] { StateArchive::surprises(archive, self.blocks_); });
  archive.section("EDGE", [&] {
    StateArchive::edges(archive, self.cache_, self.grid_, self.blocks_);
    if constexpr (Archive::loading) {
      StateArchive::check_corners(archive, self.cache_, self.grid_, self.blocks_);
    }
  });
  archive.section("SIGN", [&] { StateArchive::signal(archive, self.signal_); });
  archive.section("CHOI", [&] {
    StateArchive::choice(archive, self.choice_, self.blocks_);
    bool others = self.factors_.has_value();
    archive.number(others);
    if constexpr (Archive::loading) {
      self.shares_ = self.choice_.shares();
      if (others) self.factors_.emplace(self.grid_.size());
    }
    if (others) StateArchive::factors(archive, *self.factors_);
    StateArchive::exploration(archive, self.exploration_);
  });
  if constexpr (Archive::loading) {
    self.signal_.use_units(self.units_.exponents(), self.units_.weights());
    self.choice_.use_units(self.view(), 1);
  }
  Desk::list_pixels(archive, self);
  archive.section("WAVE", [&] { list_wave(archive, self); });
  if constexpr (Archive::loading) self.start_clock();
}

/// The wave is planned anew, from the blocks that were chosen.
template <Refiner R, BlockMeasure<R> M>
template <class Archive, class Self>
void Engine<R, M>::list_wave(Archive& archive, Self& self) {
  std::vector<Visit> chosen;
  for (const Visit& visit : self.plan_.visits()) {
    if (visit.asked > 0) chosen.push_back(visit);
  }
  archive.list(chosen, self.grid_.size(), [&](auto& visit) {
    archive.number(visit.block);
    archive.number(visit.asked);
    archive.check(visit.asked >= 1 && visit.asked <= self.longest_visit_);
  });
  if constexpr (Archive::loading) {
    if (!chosen.empty()) self.reserve({chosen.size(), self.longest_visit_});
    for (const Visit& visit : chosen) {
      archive.check(visit.block < self.grid_.size() && !self.plan_.contains(visit.block));
      const std::uint32_t first = self.blocks_.samples(visit.block);
      archive.check(visit.asked <= self.blocks_.most_samples() - first);
      self.plan_.add({visit.block, first, visit.asked, visit.asked});
    }
    self.plan_visits();
  }
  Desk::list_slots(archive, self);
}

}  // namespace freqsynth
