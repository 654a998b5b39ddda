// SPDX-License-Identifier: MIT
/// \file
/// Syntheses by a tree of nodes.
#pragma once

#include <cstddef>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/random_synthesis.h"

namespace helpers {

inline freqsynth::SynthesisSettings kriging_of(std::size_t width, std::size_t height,
                                               std::size_t channels = 1) {
  freqsynth::SynthesisSettings settings = settings_of(width, height, channels);
  settings.refiner = freqsynth::RefinerKind::kriging;
  return settings;
}

/// A random synthesis with RefinerKind::kriging, and without what that refuses.
inline RandomSynthesis random_kriging(unsigned number) {
  using namespace freqsynth;
  RandomSynthesis one(number);
  SynthesisSettings& settings = one.settings;
  settings.refiner = RefinerKind::kriging;
  settings.window = {};
  settings.quantization.reset();
  settings.max_samples_per_block = SynthesisSettings().max_samples_per_block;
  settings.list.max_terms = InverseListSettings().max_terms;
  settings.priority = {.steer = settings.priority.steer, .exposure = settings.priority.exposure};
  for (ChannelSettings& channel : settings.channel_settings) {
    if (channel.role == ChannelRole::feature) channel.role = ChannelRole::passive;
  }
  // Where nodes are deep a wave is long.
  one.stop.samples = 100 * (1 + number % 40);
  return one;
}

}  // namespace helpers
