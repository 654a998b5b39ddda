// SPDX-License-Identifier: MIT
/// \file
/// How often blocks turn out to be other than they seemed.
///
/// What no sample has hit nobody knows of: a dot between samples leaves no residual. But of many
/// blocks some are hit, and how often that has happened lately, and by how much, tells what the
/// others still hide. It is the estimate of what has not been seen by Good and Turing (1953), for
/// squares. That blocks are chosen by what they have shown does no harm: a block that seems flat is
/// asked as if it were.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The squared innovations of samples that made ten times as much of what their block's fit leaves
/// over, by the number of samples that the block had had.
class SurpriseBook {
 public:
  /// What a block's fit leaves over of one channel.
  struct Residual {
    std::size_t samples = 0;  ///< of the block
    float squares = 0;        ///< sum of the squared residuals
    float freedom = 1;        ///< degrees of freedom, at least 1
  };

  /// Nothing has happened.
  explicit SurpriseBook(std::size_t channels) : levels_(channels) {}

  /// A block that had had `before` samples has taken in `samples` more.
  void count(std::size_t before, std::size_t samples) {
    if (before >= least_samples) counts_[level_of(before)] += static_cast<double>(samples);
  }
  /// By that a channel's residuals have changed.
  void note(std::size_t channel, const Residual& before, const Residual& after) {
    const float usual = before.squares * (after.freedom / before.freedom);
    if (before.samples < least_samples || !(after.squares > many * usual)) return;
    // The fit has taken in a part of it already.
    const double square = (double{after.squares} - double{before.squares}) *
                          static_cast<double>(after.samples) / double{after.freedom};
    levels_[channel][level_of(before.samples)].add(square);
  }
  /// All values of a channel are 2 to the power of `exponent` times what they were.
  void rescale(std::size_t channel, int exponent) {
    for (Level& level : levels_[channel]) {
      level.sum = std::ldexp(level.sum, 2 * exponent);
      level.most = std::ldexp(level.most, 2 * exponent);
      level.second = std::ldexp(level.second, 2 * exponent);
    }
  }

  /// Mean square by which the next sample of a block is expected to surprise. The greatest surprise
  /// counts as the second one: a single one says nothing of others.
  /// \param samples  of the block
  [[nodiscard]] double expected(std::size_t channel, std::size_t samples) const {
    if (samples < least_samples) return 0;
    const std::size_t last = level_of(samples);
    const std::size_t first = std::max(last, level_of(least_samples) + 1) - 1;
    Level all;
    double count = 0;
    for (std::size_t level = first; level <= last; ++level) {
      all.join(levels_[channel][level]);
      count += counts_[level];
    }
    // The sum may round to less than its greatest part.
    return count > 0 ? std::max(0.0, all.sum - all.most + all.second) / count : 0;
  }

 private:
  friend struct StateArchive;

  /// As many times as much is a surprise, not the next sample of an edge.
  static constexpr float many = 10;
  /// Before that all is a surprise.
  static constexpr std::size_t least_samples = 8;

  struct Level {
    double sum = 0, most = 0, second = 0;

    void add(double square) { join({square, square, 0}); }
    void join(const Level& other) {
      sum += other.sum;
      second = std::max(std::min(most, other.most), std::max(second, other.second));
      most = std::max(most, other.most);
    }
  };
  static constexpr std::size_t levels = 24;
  [[nodiscard]] static std::size_t level_of(std::size_t samples) {
    return std::min<std::size_t>(std::bit_width(samples) - 1u, levels - 1);
  }

  std::array<double, levels> counts_ = {};         // of samples
  std::vector<std::array<Level, levels>> levels_;  // [channel]
};

}  // namespace freqsynth
