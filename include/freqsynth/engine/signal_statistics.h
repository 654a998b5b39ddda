/// \file
/// The scale of the signal: what "much" and "little" mean where blocks are compared.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The signal's variance, from the corners of all blocks: an even cover of the image, whatever is
/// sampled later.
class SignalStatistics {
 public:
  explicit SignalStatistics(std::size_t channels)
      : sums_(channels), squares_(channels), variances_(channels) {}

  /// Adds the usable values of a corner, one per channel.
  void add(const float* values);

  /// Settles the variances from what has been added. `weights` are those of the channels.
  void settle(std::span<const float> weights);

  /// Variance of the signal, mean over the channels; 0 until it is settled.
  [[nodiscard]] float variance() const { return variance_; }
  [[nodiscard]] float variance(std::size_t channel) const { return variances_[channel]; }
  /// Variances of residuals below this one are float's rounding, not the signal's.
  [[nodiscard]] float rounding() const { return rounding_; }

 private:
  std::vector<double> sums_, squares_;
  std::uint64_t count_ = 0;
  std::vector<float> variances_;
  float variance_ = 0;
  float rounding_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

inline void SignalStatistics::add(const float* values) {
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    sums_[c] += double{values[c]};
    squares_[c] += double{values[c]} * double{values[c]};
  }
  ++count_;
}

inline void SignalStatistics::settle(std::span<const float> weights) {
  double sum = 0;
  rounding_ = 0;
  const double count = static_cast<double>(std::max<std::uint64_t>(count_, 1));
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    const double mean = sums_[c] / count;
    const double mean_square = squares_[c] / count;
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

}  // namespace freqsynth
