// SPDX-License-Identifier: MIT
/// \file
/// The paper's block refiner (sections 4.1 and 4.2): least squares in the first T cosine terms.
///
/// With the shared gain k = J^-1 A a sample S changes the amplitudes X by k (S - A . X), which is
/// eq. 25 at O(T) instead of O(T^2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/refine/refiner.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// Refines the states of blocks; the states themselves belong to the caller.
///
/// A state is 64 floats per channel: the amplitudes X = G(u, v) (eq. 24) of the T terms in the fit,
/// and the right-hand sides Y (eq. 23) of the others; then 128 sums of samples per channel, for
/// each pixel by area and for each pixel of those that lie in it; then per channel the sum of
/// squared residuals (eq. 11) and the spread of the samples within pixels, see BlockFit.
class FREQSYNTH_API LeastSquaresRefiner {
 public:
  /// \param weights  weight of each channel in what absorb() returns; empty: 1 / channels
  /// \throws std::invalid_argument when there is no list, channels is 0, or the weights are not
  ///         `channels` numbers in 0..1e6.
  LeastSquaresRefiner(SharedInverseList list, std::size_t channels,
                      std::vector<float> weights = {});

  /// The list of gains.
  [[nodiscard]] const InverseList& list() const { return *list_; }
  /// A reference to it, for others to share.
  [[nodiscard]] const SharedInverseList& shared_list() const { return owner_; }
  /// Values per sample.
  [[nodiscard]] std::size_t channels() const { return channels_; }
  /// Weight of each channel.
  [[nodiscard]] std::span<const float> weights() const { return weights_; }
  /// Other weights from now on, one per channel.
  void weigh(std::span<const float> weights) { weights_.assign(weights.begin(), weights.end()); }
  /// Floats in the state of a block. States are aligned to 32 bytes.
  [[nodiscard]] std::size_t state_size() const {
    return 3 * channels_ * max_terms + (2 * channels_ + 15) / 16 * 16;
  }

  /// Puts a state to "no sample yet".
  void reset(float* state) const;
  /// Multiplies all values of a channel that a state has absorbed by 2 to the power of `exponent`.
  /// Exact as long as no value is near the ends of a float's range.
  void rescale(float* state, std::size_t channel, int exponent) const;

  /// Absorbs the values of sample `index` of the sequence; every index must come, in order.
  ///
  /// A value that is not usable is replaced by the block's own prediction, so that the sequence
  /// goes on; fit() without gaps takes it back. Before a channel's first usable value there is no
  /// prediction; the earlier samples then count as equal to that first value.
  /// \return the mean squared change of the block's pixels (of its coefficients / 8), weighted over
  ///         the channels. The first usable value of a channel, with nothing to change, counts 0.
  float absorb(float* state, std::size_t index, const float* values) const {
    float change = 0;
    absorb(state, index, values, std::span<float>(&change, 1));
    return change;
  }

  /// The same for as many samples from `index` on as there are `changes`, which receive what
  /// absorb() returns. The values of a sample follow those of the one before.
  void absorb(float* state, std::size_t index, const float* values, std::span<float> changes) const;

  /// Asks for the memory that absorb() of sample `index` will write.
  void prefetch(const float* state, std::size_t index) const { prefetch(state, index, 1); }
  /// The same for `count` samples from `index` on.
  void prefetch(const float* state, std::size_t index, std::size_t count) const;

  /// Number of samples without that of the terms fit to them, at least 1.
  [[nodiscard]] float freedom(std::size_t samples) const;
  /// Sum of the squared differences (eq. 11) between the samples of a channel and their fit.
  [[nodiscard]] float squared_residuals(const float* state, std::size_t channel) const {
    return state[3 * channels_ * max_terms + 2 * channel];
  }
  /// squared_residuals() over freedom(): weighted over the channels, and of one channel.
  [[nodiscard]] float residual(const float* state, std::size_t samples) const;
  /// The same of one channel.
  [[nodiscard]] float residual(const float* state, std::size_t samples, std::size_t channel) const {
    return squared_residuals(state, channel) / freedom(samples);
  }
  /// Terms in the fit after `samples` >= 1 samples.
  [[nodiscard]] std::size_t terms(std::size_t samples) const { return list_->terms(samples - 1); }
  /// Expected squared error of each coefficient F after `samples` >= 1 samples, per unit of
  /// residual.
  [[nodiscard]] std::span<const float, max_terms> variances(std::size_t samples) const {
    return list_->variances(samples - 1);
  }

  /// Writes the coefficients F (eq. 26, zig-zag) of a channel after `samples` samples; zeros when
  /// the channel had no usable value.
  void coefficients(const float* state, std::size_t samples, std::size_t channel,
                    std::span<float, max_terms> out) const;

  /// Sums of a channel's samples in each of the 64 pixels of the block, row by row, by area. See
  /// BlockFit, as for the next two.
  [[nodiscard]] std::span<const float, max_terms> pixel_sums(const float* state,
                                                             std::size_t channel) const {
    return std::span<const float, max_terms>(sums(state, channel), max_terms);
  }
  /// Sums of those that lie in each pixel.
  [[nodiscard]] std::span<const float, max_terms> own_sums(const float* state,
                                                           std::size_t channel) const {
    return std::span<const float, max_terms>(sums(state, channel) + max_terms, max_terms);
  }
  /// Greatest difference between a sample and the mean of the earlier ones in the same pixel.
  [[nodiscard]] float spread(const float* state, std::size_t channel) const {
    return state[3 * channels_ * max_terms + 2 * channel + 1];
  }

  /// What takes the place of an unusable value of a channel in sample `index`: the prediction of
  /// the fit, not a number before the channel's first usable value.
  [[nodiscard]] float prediction(const float* state, std::size_t index, std::size_t channel) const;

  /// fit() of all samples but those in `gaps`, with the weak prior that the energy of terms falls
  /// as that of edges does, for the samples that are left may be uneven. Costs O(samples T^2). It
  /// refers to the state and to `gaps`.
  [[nodiscard]] BlockFit fit(const float* state, std::size_t samples, std::size_t channel,
                             std::span<const Gap> gaps) const;

  /// All of this for a channel. It refers to the state.
  [[nodiscard]] BlockFit fit(const float* state, std::size_t samples, std::size_t channel) const;

 private:
  [[nodiscard]] bool all_usable(const float* state, std::span<const float> values) const;
  float absorb_channelwise(float* state, std::size_t index, const float* values) const;
  [[nodiscard]] const float* sums(const float* state, std::size_t channel) const {
    return state + (channels_ + 2 * channel) * max_terms;
  }
  void start(float* state, float* sums, std::size_t index, float value) const;

  SharedInverseList owner_;
  const InverseList* list_;
  std::size_t channels_;
  std::vector<float> weights_;
};

// ------------------------------------------------------------------------------------ definitions

/// Whether all channels have had a usable value, and all of these are.
inline bool LeastSquaresRefiner::all_usable(const float* state,
                                            std::span<const float> values) const {
  bool usable = true;
  for (std::size_t c = 0; c < channels_; ++c) usable &= !detail::is_nan(state[c * max_terms]);
  for (const float value : values) usable &= is_usable_sample(value);
  return usable;
}

inline void LeastSquaresRefiner::absorb(float* state, std::size_t index, const float* values,
                                        std::span<float> changes) const {
  const bool usable = all_usable(state, {values, changes.size() * channels_});
  for (std::size_t done = 0; done < changes.size();) {
    std::size_t count = 1;
    if (usable) [[likely]] {
      const std::span<const detail::SampleRow> rows =
          list_->rows(index + done, changes.size() - done);
      count = rows.size();
      detail::absorb_samples(rows.data(), count, state, state + channels_ * max_terms,
                             state + 3 * channels_ * max_terms, values + done * channels_,
                             weights_.data(), channels_, changes.data() + done);
    } else {
      changes[done] = absorb_channelwise(state, index + done, values + done * channels_);
    }
    done += count;
  }
}

inline void LeastSquaresRefiner::prefetch([[maybe_unused]] const float* state,
                                          [[maybe_unused]] std::size_t index,
                                          [[maybe_unused]] std::size_t count) const {
#if defined(__GNUC__)
  constexpr std::size_t line = 16;  // floats
  for (std::size_t at = 0; at < channels_ * max_terms; at += line) {
    __builtin_prefetch(state + at, 1);
  }
  __builtin_prefetch(state + 3 * channels_ * max_terms, 1);
  // Pixels that a sample has a share in lie in at most two lines. Several samples are all over the
  // block.
  constexpr std::size_t many = 3;
  if (count >= many) {
    for (std::size_t at = 0; at < 2 * channels_ * max_terms; at += line) {
      __builtin_prefetch(sums(state, 0) + at, 1);
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const detail::SampleRow& row = list_->row(index + i);
    for (std::size_t c = 0; c < channels_; ++c) {
      __builtin_prefetch(sums(state, c) + row.pixels[0], 1);
      __builtin_prefetch(sums(state, c) + row.pixels[3], 1);
      __builtin_prefetch(sums(state, c) + max_terms + row.pixels[0], 1);
    }
  }
#endif
}

inline float LeastSquaresRefiner::freedom(std::size_t samples) const {
  const std::size_t fit = samples > 0 ? terms(samples) : 0;
  const std::size_t free = samples > fit ? samples - fit : 1;
  // Processors convert numbers with a sign at once, others step by step.
  return static_cast<float>(static_cast<std::int64_t>(free));
}

inline float LeastSquaresRefiner::residual(const float* state, std::size_t samples) const {
  float squares = 0;
  for (std::size_t c = 0; c < channels_; ++c) squares += weights_[c] * squared_residuals(state, c);
  // Large weights of large values may be more than a float holds.
  constexpr float most = 1e34f;
  const float residual = squares / freedom(samples);
  return residual < most ? residual : most;
}

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/refine/least_squares_refiner.inl"
#endif
