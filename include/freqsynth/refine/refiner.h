// SPDX-License-Identifier: MIT
/// \file
/// What an estimator of blocks must do. The engine knows no more of it than this concept: what a
/// block keeps, how it takes in the next value, what is left over, and what the block is then.
///
/// A refiner holds no block. A block's state is `state_size()` floats, aligned to a cache line and
/// owned by the engine; their meaning is the refiner's alone. "After n samples" means after the
/// samples 0 .. n - 1 of the shared sequence, each of which was absorbed once, in order.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "freqsynth/basis/config.h"

namespace freqsynth {

class InverseList;

/// Largest magnitude of a value, in the unit of the states, whose squares a refiner has to bear.
inline constexpr float most_state_value = 0x1p50f;

/// A sample that had no usable value: its index in the sequence, and what was absorbed in its
/// place.
struct Gap {
  std::uint32_t sample = 0;  ///< index in the sequence
  float value = 0;           ///< a prediction, no information
};

/// What an estimator says of one channel of a block; what images are made of.
struct BlockFit {
  /// F (eqs. 1, 2) in zig-zag order; zeros when the channel had no usable value.
  std::array<float, max_terms> coefficients;
  /// Sums of the channel's samples in each of the 64 pixels, row by row; a sample counts for the
  /// pixels around it by area, see detail::SampleRow::pixel_weights.
  std::span<const float, max_terms> pixel_sums;
  float residual = 0;  ///< variance of what the fit leaves over
  /// Samples that are in the sums with a value that is none; the fit and the residual do without
  /// them.
  std::span<const Gap> gaps = {};
  /// The same of the samples that lie in the pixel, those on pixels' borders left out: 64 numbers,
  /// or none, when that is not known.
  std::span<const float> own_sums = {};
  /// Greatest difference between a sample and the mean of the earlier ones in the same pixel.
  float spread = 0;
};

template <class R>
concept Refiner = requires(R& own, const R& refiner, float* state, const float* known,
                           const float* values, std::size_t n, std::size_t channel,
                           std::span<float, max_terms> coefficients, int exponent) {
  /// The sequence that it follows, and what is shared by all blocks.
  { refiner.list() } -> std::same_as<const InverseList&>;
  { refiner.channels() } -> std::same_as<std::size_t>;
  /// Weight of each channel where one number has to stand for all.
  { refiner.weights() } -> std::same_as<std::span<const float>>;
  /// Other weights from now on.
  { own.weigh(std::span<const float>{}) } -> std::same_as<void>;

  /// Floats that a block keeps.
  { refiner.state_size() } -> std::same_as<std::size_t>;
  /// Puts a state to "no sample yet".
  { refiner.reset(state) } -> std::same_as<void>;
  /// Multiplies all values of a channel that a state has absorbed by 2 to the power of an exponent.
  { refiner.rescale(state, channel, exponent) } -> std::same_as<void>;
  /// Takes in the values of sample n, one per channel; returns the mean squared change of the
  /// block's pixels, weighted over the channels.
  { refiner.absorb(state, n, values) } -> std::same_as<float>;
  /// Hints that sample n will be absorbed soon.
  { refiner.prefetch(known, n) } -> std::same_as<void>;

  /// Degrees of freedom of the residuals after n samples, at least 1.
  { refiner.freedom(n) } -> std::same_as<float>;
  /// Variance of the residuals after n samples, weighted over the channels, and of one channel.
  { refiner.residual(known, n) } -> std::same_as<float>;
  { refiner.residual(known, n, channel) } -> std::same_as<float>;
  /// Number of parameters that n >= 1 samples have been fit with.
  { refiner.terms(n) } -> std::same_as<std::size_t>;
  /// Expected squared error of each coefficient after n >= 1 samples, per unit of residual.
  { refiner.variances(n) } -> std::same_as<std::span<const float, max_terms>>;

  /// The coefficients alone, and all that the block is after n samples.
  { refiner.coefficients(known, n, channel, coefficients) } -> std::same_as<void>;
  { refiner.fit(known, n, channel) } -> std::same_as<BlockFit>;
};

/// A refiner that puts a prediction in the place of a value that is not usable, and can tell later
/// what the fit is without it.
template <class R>
concept FillsGaps = Refiner<R> && requires(const R& refiner, const float* known, std::size_t n,
                                           std::size_t channel, std::span<const Gap> gaps) {
  /// What absorb() of sample n will take for a value of the channel that is not usable; not a
  /// number when it cannot yet: then the first value that is usable will stand for all before it.
  { refiner.prediction(known, n, channel) } -> std::same_as<float>;
  /// The fit without the samples in `gaps`.
  { refiner.fit(known, n, channel, gaps) } -> std::same_as<BlockFit>;
};

/// A refiner that takes in several samples at once, faster than one after the other.
template <class R>
concept RefinesRuns = Refiner<R> && requires(const R& refiner, float* state, std::size_t n,
                                             const float* values, std::span<float> changes) {
  /// What absorb() of the samples n, n + 1, .. does, as many as there are changes. The values of a
  /// sample follow those of the one before.
  { refiner.absorb(state, n, values, changes) } -> std::same_as<void>;
  /// Hints that so many samples from n on will be absorbed soon.
  { refiner.prefetch(state, n, changes.size()) } -> std::same_as<void>;
};

}  // namespace freqsynth
