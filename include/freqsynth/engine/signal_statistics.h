// SPDX-License-Identifier: MIT
/// \file
/// The scale of the signal: what "much" and "little" mean where blocks are compared.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The range that most of a channel's values lie in: all but the few highest and lowest ones, so
/// that a stray value does not widen it.
class UsualRange {
 public:
  /// Takes in a value and keeps it if it is one of the highest, or of the lowest among the others.
  /// \return the value that is kept no longer, if any: it itself, or one that it displaces
  std::optional<float> add(float value);
  /// Width of the range; 0 while there are few values.
  [[nodiscard]] float width() const { return std::max(high_.back() - low_.back(), 0.0f); }
  /// The value itself or, when it lies outside by more than the width of the range, its nearer end.
  [[nodiscard]] float plausible(float value) const;
  /// Calls visit(value) for each value that is kept.
  template <class Visitor>
  void visit_kept(Visitor&& visit) const;

 private:
  friend struct StateArchive;

  static constexpr std::size_t few = 4;
  static constexpr float none = std::numeric_limits<float>::max() / 2;

  std::array<float, few> high_{-none, -none, -none, -none};  // highest first
  std::array<float, few> low_{none, none, none, none};       // lowest first
};

/// The signal's variance, from the corners of all blocks: an even cover of the image, whatever is
/// sampled later. And how far its values are from each other, from all samples.
///
/// A single stray value (a firefly of a path tracer) changes neither.
class SignalStatistics {
 public:
  /// Nothing is known yet.
  explicit SignalStatistics(std::size_t channels)
      : sums_(channels),
        corner_ranges_(channels),
        ranges_(channels),
        settled_variances_(channels),
        mean_squares_(channels),
        factors_(channels, 1.0f),
        variances_(channels) {}

  /// Takes in a usable value of a sample, in the host's unit.
  void note(std::size_t channel, float value) { ranges_[channel].add(value); }
  /// Takes in that of a corner, too.
  void add(std::size_t channel, float value);
  /// Takes in usable values of a sample, one per channel.
  void note(const float* values);
  /// Takes in those of a corner, too.
  void add(const float* values);

  /// Settles the variances from what has been added. `weights` are those of the channels.
  void settle(std::span<const float> weights);
  /// Whether it is.
  [[nodiscard]] bool settled() const { return settled_; }
  /// Says all in these units: each channel's is 2 to the power of its exponent. At first they are
  /// 1. `weights` are those of the channels in these units.
  void use_units(std::span<const int> exponents, std::span<const float> weights);

  /// Variance of the signal, weighted over the channels; 0 until it is settled.
  [[nodiscard]] float variance() const { return variance_; }
  /// The same of one channel.
  [[nodiscard]] float variance(std::size_t channel) const { return variances_[channel]; }
  /// Variances of residuals below this one are float's rounding, not the signal's.
  [[nodiscard]] float rounding() const { return rounding_; }

  /// Largest variance that values of a channel can have in the signal's range (Popoviciu), stray
  /// ones aside. Without limit until the variances are settled.
  [[nodiscard]] float most_variance(std::size_t channel) const;
  /// The same, weighted over the channels.
  [[nodiscard]] float most_variance(std::span<const float> weights) const;

 private:
  friend struct StateArchive;

  struct Sums {
    double values = 0, squares = 0;
    std::uint64_t count = 0;  // with those that are kept aside

    void add(double value) {
      values += value;
      squares += value * value;
    }
  };

  void weigh(std::span<const float> weights);

  static constexpr float without_limit = 1e31f;  // no usable samples have a larger variance

  // In the host's units:
  std::vector<Sums> sums_;  // of the corners
  std::vector<UsualRange> corner_ranges_, ranges_;
  std::vector<double> settled_variances_, mean_squares_;
  bool settled_ = false;
  // In those in use:
  std::vector<float> factors_;  // of a value: 1 / unit
  std::vector<float> variances_;
  float variance_ = 0;
  float rounding_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

inline std::optional<float> UsualRange::add(float value) {
  if (value > high_.back()) {
    const float displaced = high_.back();
    std::size_t place = few - 1;
    for (; place > 0 && high_[place - 1] < value; --place) high_[place] = high_[place - 1];
    high_[place] = value;
    if (displaced == -none) return std::nullopt;
    value = displaced;
  }
  if (value < low_.back()) {
    const float displaced = low_.back();
    std::size_t place = few - 1;
    for (; place > 0 && low_[place - 1] > value; --place) low_[place] = low_[place - 1];
    low_[place] = value;
    if (displaced == none) return std::nullopt;
    value = displaced;
  }
  return value;
}

inline float UsualRange::plausible(float value) const {
  // Of a signal that is flat but for a few samples nobody can say what is stray.
  if (width() == 0) return value;
  if (value > high_.back() + width()) return high_.back();
  if (value < low_.back() - width()) return low_.back();
  return value;
}

template <class Visitor>
void UsualRange::visit_kept(Visitor&& visit) const {
  for (const float value : high_) {
    if (value != -none) visit(value);
  }
  for (const float value : low_) {
    if (value != none) visit(value);
  }
}

inline void SignalStatistics::note(const float* values) {
  for (std::size_t c = 0; c < ranges_.size(); ++c) ranges_[c].add(values[c]);
}

inline void SignalStatistics::add(std::size_t channel, float value) {
  if (const auto kept = corner_ranges_[channel].add(value)) sums_[channel].add(double{*kept});
  ++sums_[channel].count;
}

inline void SignalStatistics::add(const float* values) {
  for (std::size_t c = 0; c < sums_.size(); ++c) add(c, values[c]);
}

inline void SignalStatistics::settle(std::span<const float> weights) {
  settled_ = true;
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    // The outermost values only now, for one that is stray would take all digits of the sums.
    const UsualRange& range = corner_ranges_[c];
    Sums all = sums_[c];
    const double count = static_cast<double>(std::max<std::uint64_t>(all.count, 1));
    range.visit_kept([&](float value) { all.add(double{range.plausible(value)}); });
    const double mean = all.values / count;
    const double mean_square = all.squares / count;
    // A flat first impression leaves some doubt, in proportion to the level, so that blocks stay in
    // order.
    settled_variances_[c] = std::max(mean_square - mean * mean, 1e-6 * mean_square);
    mean_squares_[c] = mean_square;
  }
  weigh(weights);
}

inline void SignalStatistics::use_units(std::span<const int> exponents,
                                        std::span<const float> weights) {
  for (std::size_t c = 0; c < factors_.size(); ++c) factors_[c] = std::ldexp(1.0f, -exponents[c]);
  if (settled_) weigh(weights);
}

inline void SignalStatistics::weigh(std::span<const float> weights) {
  constexpr double least = 1e-24;  // of a signal that is 0 at all corners
  double sum = 0, channels = 0;
  rounding_ = 0;
  const double largest = double{*std::max_element(weights.begin(), weights.end())};
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    const double square = double{factors_[c]} * double{factors_[c]};
    const double variance = std::max(settled_variances_[c] * square, least);
    variances_[c] = static_cast<float>(variance);
    // Relative to the largest, so that with equal weights it is the plain mean to the bit.
    if (weights[c] == 0) continue;
    sum += double{weights[c]} / largest * variance;
    ++channels;
    rounding_ += static_cast<float>(1e-12 * mean_squares_[c] * square) * weights[c];
  }
  // Where no channel counts, the number of samples does.
  variance_ = 1;
  if (channels == 0) return;
  sum = sum / channels * double{static_cast<float>(largest * channels)};
  variance_ = static_cast<float>(std::min(sum, double{without_limit}));
}

inline float SignalStatistics::most_variance(std::size_t channel) const {
  const float width = ranges_[channel].width() * factors_[channel];
  // A range of nothing says nothing.
  return variance_ > 0 && width > 0 ? 0.25f * width * width : without_limit;
}

inline float SignalStatistics::most_variance(std::span<const float> weights) const {
  float most = 0;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    if (weights[c] > 0) most += weights[c] * most_variance(c);
  }
  return most;
}

}  // namespace freqsynth
