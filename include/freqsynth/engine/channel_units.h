// SPDX-License-Identifier: MIT
/// \file
/// The units that blocks keep the values of each channel in: whatever a host's unit is, squares of
/// values stay within what a float can hold.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/refine/refiner.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// A unit per channel, a power of two, so that to change it rounds nothing. It is about the median
/// magnitude of the first wave's values that are not 0, and stays unless values of another order
/// come.
///
/// Channels are compared in the host's units. So where one number stands for all, each has its
/// weight times the square of its unit, relative to the largest such product.
class ChannelUnits {
 public:
  /// All units are 1 until a value is seen. `weights` are the host's; a channel with weight 0 has
  /// no say beyond itself.
  explicit ChannelUnits(std::span<const float> weights)
      : host_weights_(weights.begin(), weights.end()),
        weights_(host_weights_),
        exponents_(weights.size()),
        limits_(weights.size()),
        far_(weights.size()) {
    while (first_ < weights.size() && weights[first_] == 0) ++first_;
    weigh();
  }

  /// Whether the values, `channels` for each sample, fit the units. Values that are not usable do.
  [[nodiscard]] bool fit(std::span<const float> values) const {
    const std::size_t channels = limits_.size();
    for (std::size_t i = 0; i < values.size(); i += channels) {
      std::uint32_t over = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        over |= magnitude(values[i + c]) > limits_[c] ? 1u : 0u;
      }
      if (over == 0) continue;
      for (std::size_t c = 0; c < channels; ++c) {
        const float value = values[i + c];
        if (magnitude(value) > limits_[c] && is_usable_sample(value)) return false;
      }
    }
    return true;
  }

  /// Chooses units that the values fit. The first few that are 2^100 times as large as the unit, or
  /// more, are beyond belief and become NaN: a single one would take all digits of the others.
  void revise(std::span<float> values);

  /// Binary logarithm of the unit of a channel.
  [[nodiscard]] int exponent(std::size_t channel) const { return exponents_[channel]; }
  /// The same of all channels.
  [[nodiscard]] std::span<const int> exponents() const { return exponents_; }
  /// The same where one number stands for all channels.
  [[nodiscard]] int exponent() const { return common_; }
  /// Whether a channel that counts has had a value other than 0.
  [[nodiscard]] bool known() const { return known_; }
  /// Weight of each channel's values in its unit.
  [[nodiscard]] std::span<const float> weights() const { return weights_; }

 private:
  friend struct StateArchive;

  static constexpr int most_exponent = 50;
  static_assert(most_state_value == 0x1p50f);
  static constexpr std::uint32_t few = 4;
  static constexpr int beyond_belief = 100;

  static std::uint32_t magnitude(float value) {
    return std::bit_cast<std::uint32_t>(value) & 0x7fffffffu;
  }
  /// Binary logarithm, rounded down, of the median magnitude.
  static int median_exponent(std::span<const float> values, std::size_t first, std::size_t step);
  void set(std::size_t channel, int exponent);
  void weigh();

  std::vector<float> host_weights_, weights_;
  std::vector<int> exponents_;
  std::vector<std::uint32_t> limits_;  // bits of the largest magnitude that fits; 0: none is known
  std::vector<std::uint32_t> far_;     // values beyond belief so far
  std::size_t first_ = 0;              // channel with a weight
  int common_ = 0;
  bool known_ = false;
};

// ------------------------------------------------------------------------------------ definitions

inline void ChannelUnits::revise(std::span<float> values) {
  const std::size_t channels = limits_.size();
  for (std::size_t c = 0; c < channels; ++c) {
    const int usual = limits_[c] != 0 ? exponents_[c] : median_exponent(values, c, channels);
    float largest = 0;
    for (std::size_t i = c; i < values.size(); i += channels) {
      if (!is_usable_sample(values[i])) continue;
      const float size = std::abs(values[i]);
      const bool stray = std::ldexp(double{size}, -usual) > std::ldexp(1.0, beyond_belief);
      if (stray && far_[c] < few) {
        ++far_[c];
        values[i] = std::bit_cast<float>(0x7fc00000u);
      } else {
        largest = std::max(largest, size);
      }
    }
    if (magnitude(largest) <= limits_[c]) continue;
    // Where values outgrow a unit, the others keep as many digits as they can.
    set(c, std::max(std::ilogb(largest) - most_exponent + 2, usual));
  }
  weigh();
}

/// Without memory of its own, for nothing here may fail: counts the exponents.
inline int ChannelUnits::median_exponent(std::span<const float> values, std::size_t first,
                                         std::size_t step) {
  constexpr int least = -150;
  std::array<std::uint32_t, 300> counts{};  // of magnitudes from 2^least on
  std::uint64_t all = 0;
  for (std::size_t i = first; i < values.size(); i += step) {
    if (!is_usable_sample(values[i]) || values[i] == 0) continue;
    ++counts[static_cast<std::size_t>(std::ilogb(values[i]) - least)];
    ++all;
  }
  std::uint64_t below = 0;
  std::size_t at = 0;
  while (2 * (below + counts[at]) < all) below += counts[at++];
  if (all == 0) return 0;
  return static_cast<int>(at) + least;
}

inline void ChannelUnits::set(std::size_t channel, int exponent) {
  // The inverse of the unit has to be a float, too.
  exponents_[channel] = std::clamp(exponent, -126, 126);
  const double limit = std::ldexp(1.0, std::min(exponents_[channel] + most_exponent, 127));
  limits_[channel] = std::bit_cast<std::uint32_t>(static_cast<float>(limit));
}

inline void ChannelUnits::weigh() {
  // A weight is about the square of 2 to the power of this.
  const auto root = [this](std::size_t c) { return std::ilogb(host_weights_[c]) >> 1; };
  const auto knows = [this](std::size_t c) { return limits_[c] != 0; };
  known_ = false;
  for (std::size_t c = 0; c < limits_.size(); ++c) {
    if (host_weights_[c] == 0 || (known_ && !knows(c))) continue;
    const int own = root(c) + exponents_[c];
    // Those that know nothing but 0 have a say as long as there is no other.
    common_ = c == first_ || (knows(c) && !known_) ? own : std::max(common_, own);
    known_ = known_ || knows(c);
  }
  for (std::size_t c = 0; c < limits_.size(); ++c) {
    if (host_weights_[c] == 0) continue;
    const int shift = knows(c) ? exponents_[c] - common_ : -root(c);
    weights_[c] = std::ldexp(host_weights_[c], 2 * shift);
  }
}

}  // namespace freqsynth
