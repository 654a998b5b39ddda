// SPDX-License-Identifier: MIT
/// \file
/// The scale of the signal: what "much" and "little" mean where blocks are compared.
#pragma once

#include <algorithm>
#include <array>
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
      : sums_(channels), corner_ranges_(channels), ranges_(channels), variances_(channels) {}

  /// Takes in the usable values of a sample, one per channel.
  void note(const float* values);
  /// Takes in those of a corner, too.
  void add(const float* values);

  /// Settles the variances from what has been added. `weights` are those of the channels.
  void settle(std::span<const float> weights);

  /// Variance of the signal, mean over the channels; 0 until it is settled.
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
  struct Sums {
    double values = 0, squares = 0;

    void add(double value) {
      values += value;
      squares += value * value;
    }
  };

  std::vector<Sums> sums_;  // of the corners
  std::uint64_t count_ = 0;
  std::vector<UsualRange> corner_ranges_, ranges_;
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

inline void SignalStatistics::add(const float* values) {
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    if (const auto value = corner_ranges_[c].add(values[c])) sums_[c].add(double{*value});
  }
  ++count_;
}

inline void SignalStatistics::settle(std::span<const float> weights) {
  double sum = 0;
  rounding_ = 0;
  const double count = static_cast<double>(std::max<std::uint64_t>(count_, 1));
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    // The outermost values only now, for one that is stray would take all digits of the sums.
    const UsualRange& range = corner_ranges_[c];
    Sums all = sums_[c];
    range.visit_kept([&](float value) { all.add(double{range.plausible(value)}); });
    const double mean = all.values / count;
    const double mean_square = all.squares / count;
    // A flat first impression leaves some doubt, in proportion to the level, so that blocks stay in
    // order.
    const double least = std::max(1e-6 * mean_square, 1e-24);
    const double variance = std::max(mean_square - mean * mean, least);
    variances_[c] = static_cast<float>(variance);
    sum += variance;
    rounding_ += static_cast<float>(1e-12 * mean_square) * weights[c];
  }
  variance_ = static_cast<float>(sum / static_cast<double>(sums_.size()));
}

inline float SignalStatistics::most_variance(std::size_t channel) const {
  constexpr float without_limit = 1e31f;  // no usable samples have a larger one
  const float width = ranges_[channel].width();
  // A range of nothing says nothing.
  return variance_ > 0 && width > 0 ? 0.25f * width * width : without_limit;
}

inline float SignalStatistics::most_variance(std::span<const float> weights) const {
  float most = 0;
  for (std::size_t c = 0; c < weights.size(); ++c) most += weights[c] * most_variance(c);
  return most;
}

}  // namespace freqsynth
