// SPDX-License-Identifier: MIT
/// \file
/// What each channel of a sample is for.
#pragma once

#include <cstdint>

namespace freqsynth {

/// What a channel does.
enum class ChannelRole : std::uint8_t {
  /// Its errors decide where samples go, by its weight.
  steer,
  /// It rides along: it gets the best image that the samples of the others allow, and influences
  /// nothing else, whatever its values are. For what is wanted as a picture of its own, too.
  passive,
  /// As `passive`, but where there is noise it guides the smoothing of the channels that steer. For
  /// what is known of the first surface with little noise: colour, normal, one over the distance.
  feature,
  /// For what must not be averaged, such as ids and depth: each pixel has a value that was sampled
  /// in it, the one nearest to its centre, to the bit. It influences nothing else. Any value but
  /// NaN is usable, infinity as well. Its pixels are those of Synthesizer::channel_pixels(); it has
  /// no coefficients.
  nearest,
  /// For layers beside the picture that need not be better than plain ones, at a third of what
  /// `passive` costs: each pixel has the mean of what was sampled in it. It influences nothing
  /// else. Its pixels are those of Synthesizer::channel_pixels(); it has no coefficients.
  mean,
  /// As `mean`, but it guides the smoothing of noise as `feature` does, at a third of the engine's
  /// time. Nearly as good where it has no noise of its own; where it has, as behind a lens, and
  /// where every block has edges, `feature` is better.
  mean_feature
};

/// Whether blocks fit channels of a role: these are the channels that images have.
[[nodiscard]] constexpr bool has_coefficients(ChannelRole role) {
  return role < ChannelRole::nearest;
}

/// A channel. `{}` is one that steers.
struct ChannelSettings {
  ChannelRole role = ChannelRole::steer;  ///< what it does
  /// Of its squared errors among those of all channels that steer, in 1e-30..1e6. Only the weights'
  /// proportions matter. Not read in the other roles.
  float weight = 1;
};

}  // namespace freqsynth
