// SPDX-License-Identifier: MIT
/// \file
/// How noise is noticed: some samples are asked for twice.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// Which samples are asked for twice: of n samples, root n at most. So the share that it costs
/// falls, and yet noise that is rare, or in a small part of the picture, is met in the end. One is
/// picked at random among the samples (k - 1)^2 + 1 .. k^2 for each k from 2 on.
class NoiseProbes {
 public:
  /// Most of so many samples in a row that are asked for twice.
  [[nodiscard]] static std::size_t most(std::size_t samples) {
    return static_cast<std::size_t>(std::sqrt(static_cast<double>(samples))) + 2;
  }

  /// Calls probe(i), in order, for each of `count` samples that is to be asked for twice, when
  /// `before` samples have come before them; every sample comes in one call.
  template <class Probe>
  void visit(std::uint64_t before, std::size_t count, Probe&& probe) {
    for (; next_ < before + count; next_ = place(++number_)) {
      if (next_ >= before) probe(static_cast<std::size_t>(next_ - before));
    }
  }

  /// Whether two values of one position differ by more than rounding: by more than 1e-4 of the
  /// larger one. Values that are not usable differ from none.
  [[nodiscard]] static bool differ(float one, float other) {
    if (!is_usable_sample(one) || !is_usable_sample(other)) return false;
    return std::abs(one - other) > 1e-4f * std::fmax(std::abs(one), std::abs(other));
  }

 private:
  friend struct StateArchive;

  /// The sample, counted from 0.
  [[nodiscard]] static std::uint64_t place(std::uint64_t number) {
    return (number - 1) * (number - 1) + detail::mix_bits(number) % (2 * number - 1);
  }

  std::uint64_t number_ = 2;
  std::uint64_t next_ = place(2);
};

}  // namespace freqsynth
