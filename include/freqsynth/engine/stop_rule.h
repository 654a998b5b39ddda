// SPDX-License-Identifier: MIT
/// \file
/// When a synthesis ends, and what it says of itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// When to stop; the first rule that holds ends the synthesis. All rules but `seconds` count from
/// the engine's creation, so that raising them goes on.
///
/// None can make a synthesis endless: whatever they say, it ends when every block has
/// SynthesisSettings::max_samples_per_block.
struct StopRule {
  /// Samples per pixel, fractions included; rounded to whole samples. >= 0. The few that are asked
  /// for twice, see SynthesisStats::probes, count once, as in all rules.
  double samples_per_pixel = std::numeric_limits<double>::infinity();
  /// Samples in total.
  std::uint64_t samples = std::numeric_limits<std::uint64_t>::max();
  /// Seconds of wall-clock time, >= 0, from the moment at which the rule is set: when run() begins,
  /// or set_stop() is called. Then no position is handed out any more, in the middle of a wave too,
  /// so that run() comes back after the batch that is under way. What came in of that wave is kept
  /// for a later run; images show completed waves. More than 1e9 are no limit.
  double seconds = std::numeric_limits<double>::infinity();
  /// Synthesizer::predicted_rmse(), the error that finished pixels are expected to have, in the
  /// signal's unit, >= 0; 0: no target. It is looked at between waves, four times while samples
  /// double, from 5 samples in each block on: so up to a quarter more samples are taken than it
  /// needs. What no sample has hit nobody knows: an expectation, not a bound.
  double target_rmse = 0;
  /// The aliasing threshold of section 4.4 in the signal's unit, >= 0: no block changes by more
  /// with its next sample, as root mean square over its pixels and by the estimate of
  /// PrioritySettings::measure. Not an error bound. Where PrioritySettings::steer is not linear,
  /// its unit is that of what is seen: a share of the value, or of the display's range.
  double aliasing_threshold = 0;
  /// The aliasing threshold ends nothing before each block has had that many samples; those whose
  /// importance is 0 aside. 25 are a complete lattice of 5 x 5: that much of any image is looked
  /// at, whatever the first samples say.
  std::size_t least_samples = 25;

  /// \throws std::invalid_argument when a rule is negative or not a number.
  FREQSYNTH_API void validate() const;
  /// Most samples of an image of so many pixels.
  [[nodiscard]] FREQSYNTH_API std::uint64_t most_samples(std::size_t width,
                                                         std::size_t height) const;
};

/// Why no more positions are handed out.
enum class StopReason {
  samples,     ///< the number of samples is reached
  threshold,   ///< every block is below the aliasing threshold, or meets the quantization target
  exhausted,   ///< every block has its most samples, or there is no block
  cancelled,   ///< the progress callback said so, or cancel() was called
  waiting,     ///< positions handed out by request() elsewhere are still owed
  unusable,    ///< not one sample had a usable value: there is no image
  seconds,     ///< the time is over
  target_rmse  ///< the expected error is small enough
};

/// Counters since the engine's creation.
struct SynthesisStats {
  /// Samples that were delivered. With `probes` these are all calls of the sampler that succeeded.
  std::uint64_t samples = 0;
  /// Of these, so many were asked for a second time to notice noise: about root `samples`. Stop
  /// rules and progress do not count the second ones.
  std::uint64_t probes = 0;
  /// Probes whose second value was another one than the first: with Noise::none, a sign that the
  /// sampler is noisy after all; none of many with Noise::present, that it is not.
  std::uint64_t differing_probes = 0;
  std::uint64_t absorbed = 0;  ///< samples taken in by blocks; border samples count for each block
  /// Samples with a value that is not is_usable_sample() in a channel that steers; or in any with
  /// coefficients, where none steers.
  std::uint64_t bad_samples = 0;
  /// Samples with such a value only in channels that do not steer, NaN where the role is
  /// ChannelRole::nearest. They are no bad samples: for all other channels they are as good as any.
  std::uint64_t ignored_bad_samples = 0;
  /// Requests that were abandoned. They are among `samples` or `probes`, as if they had been
  /// delivered, so that rules and progress count them; but they are no bad samples.
  std::uint64_t abandoned = 0;
  std::uint64_t waves = 0;   ///< waves completed
  std::uint64_t blocks = 0;  ///< blocks of the image
};

/// Where a bad sample was.
struct BadSample {
  double x = 0;          ///< continuous pixels to the right
  double y = 0;          ///< continuous pixels downwards
  std::uint64_t id = 0;  ///< that of its Request
};

/// How far a synthesis is.
struct Progress {
  /// Share of the way to the end, 0..1, by the rule that is furthest along: samples, seconds, the
  /// target of the error (roughly), or the most samples that blocks may have. The aliasing
  /// threshold and a quantization target may end it earlier. It is 1 at the end and not before, and
  /// never falls until rules are set anew.
  double fraction = 0;
  double seconds = 0;  ///< since the rules were set
  /// Until the end, at the pace since the rules were set: 0 at the end, infinity while unknown. The
  /// rest of a batch and the finishing of the picture come on top.
  double seconds_left = std::numeric_limits<double>::infinity();
  std::uint64_t samples = 0;  ///< see SynthesisStats::samples
  /// Of the picture: the number of completed waves. image() is another one when this is.
  std::uint64_t revision = 0;
  /// Synthesizer::predicted_rmse() when StopRule::target_rmse was looked at last; infinity before.
  double predicted_rmse = std::numeric_limits<double>::infinity();
};

/// What run() did.
struct RunReport {
  StopReason reason = StopReason::samples;  ///< why it came back
  double sampler_seconds = 0;  ///< wall-clock time with the sampler and its executor at work
  double core_seconds = 0;     ///< the rest: choosing, refining
  bool noise_seen = false;     ///< see SynthesisStats::differing_probes
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/engine/stop_rule.inl"
#endif
