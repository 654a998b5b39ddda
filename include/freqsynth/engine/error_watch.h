// SPDX-License-Identifier: MIT
/// \file
/// When an engine looks at the error that its pictures are expected to have.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "freqsynth/basis/config.h"

namespace freqsynth {

struct StateArchive;

/// Looks cost about as much as a sample or two in each block, so there are four each time that the
/// samples double, between waves, from five in each block on. Where they are depends on the samples
/// of blocks alone, and not on who set which rules when: so a synthesis that was interrupted ends
/// at the same sample as another one.
class ErrorWatch {
 public:
  /// The first number of absorbed samples above `absorbed` at which there is a look.
  [[nodiscard]] static std::uint64_t next_look(std::uint64_t absorbed, std::uint64_t blocks) {
    const std::uint64_t step = std::max<std::uint64_t>(std::bit_floor(absorbed) / 4, 1);
    return std::max((absorbed / step + 1) * step, 5 * blocks);
  }

  /// \param blocks  of the image
  explicit ErrorWatch(std::uint64_t blocks) : next_(next_look(0, blocks)), blocks_(blocks) {}

  /// Whether it is time.
  [[nodiscard]] bool due(std::uint64_t absorbed) const { return absorbed >= next_; }
  /// Takes note that a wave begins: this place has been passed.
  void pass(std::uint64_t absorbed) {
    if (due(absorbed)) next_ = next_look(absorbed, blocks_);
  }

  /// The error, which is predict(), but not twice in one place.
  template <class Predict>
  double look(std::uint64_t absorbed, Predict&& predict) {
    if (place_ != absorbed) {
      last_ = predict();
      place_ = absorbed;
      least_ = std::min(least_, last_);
    }
    return last_;
  }
  /// The newest error that was looked at, infinity at first.
  [[nodiscard]] double last() const { return last_; }
  /// The smallest one.
  [[nodiscard]] double least() const { return least_; }

 private:
  friend struct StateArchive;

  std::uint64_t next_, blocks_;
  std::uint64_t place_ = 0;  // of the newest look
  double last_ = std::numeric_limits<double>::infinity();
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace freqsynth
