// SPDX-License-Identifier: MIT
// What is saved of the half of an engine that faces the host.
#pragma once

#include "freqsynth/engine/state_archive.h"

namespace freqsynth {

template <class Self>
template <class Archive, class Engine>
void HostDesk<Self>::list_desk(Archive& archive, Engine& self) {
  archive.number(self.noise_);
  archive.check(self.noise_ <= Noise::present);
  archive.number(self.any_usable_);
  archive.number(self.patience_);
  StateArchive::stats(archive, self.stats_);
  StateArchive::stop(archive, self.stop_);
  StateArchive::errors(archive, self.errors_);
  StateArchive::bad_samples(archive, self.bad_, most_bad_reported);
}

template <class Self>
template <class Archive, class Engine>
void HostDesk<Self>::list_pixels(Archive& archive, Engine& self) {
  archive.section("PIXL", [&] { StateArchive::pixels(archive, self.pixels_); });
  archive.section("NEAR", [&] { StateArchive::apart(archive, self.apart_); });
}

template <class Self>
template <class Archive, class Engine>
void HostDesk<Self>::list_slots(Archive& archive, Engine& self) {
  std::vector<std::uint32_t> repeated;
  for (std::size_t i = self.wave_.samples(); i < self.wave_.size(); ++i) {
    repeated.push_back(self.wave_.slot(i).repeated);
  }
  archive.list(repeated, NoiseProbes::most(self.wave_.samples()));
  if constexpr (Archive::loading) {
    for (std::size_t i = 0; i < repeated.size(); ++i) {
      archive.check(repeated[i] < self.wave_.samples() &&
                    (i == 0 || repeated[i] > repeated[i - 1]));
      self.wave_.repeat(repeated[i]);
    }
  }
  StateArchive::wave(archive, self.wave_);
  StateArchive::probes(archive, self.probes_, self.stats_.samples + self.wave_.samples());
  if constexpr (Archive::loading) {
    for (std::uint32_t i = 0; i < self.wave_.size(); ++i) {
      Wave::Slot& slot = self.wave_.slot(i);
      if (slot.ordinal != Wave::Slot::no_ordinal) slot.id = self.make_request(i).id;
    }
  }
}

}  // namespace freqsynth
