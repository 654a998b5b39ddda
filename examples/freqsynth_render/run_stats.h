// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/synthesizer.h"
#include "options.h"

struct Seconds {
  double sampler = 0, core = 0, wall = 0;
};

double samples_per_pixel(const Options& options, const freqsynth::SynthesisStats& stats);

/// Writes the figures of a run as JSON to options.stats.
/// \throws std::runtime_error naming the file and the reason.
void write_stats(const Options& options, const freqsynth::SynthesisStats& stats,
                 freqsynth::StopReason reason, const Seconds& seconds);
