// SPDX-License-Identifier: MIT
/// \file
/// The paper's refiner word by word: slow, and easy to believe.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"

namespace freqsynth {

/// The paper's literal path for one channel: Y is summed up and X = J^-1 Y (eq. 25) solved anew,
/// O(T^2) a sample. It gives the same X as LeastSquaresRefiner: the oracle of its tests and the
/// competitor of its benchmark.
class FREQSYNTH_API LiteralRefiner {
 public:
  /// Starts with no sample. There is a list.
  explicit LiteralRefiner(SharedInverseList list) : list_(std::move(list)) {}

  /// Adds the next sample to Y (eq. 23) and solves for X (eq. 25).
  void absorb(double value);

  /// Amplitudes X of the terms in the fit.
  [[nodiscard]] std::span<const double> amplitudes() const { return {x_, terms_}; }

 private:
  SharedInverseList list_;
  std::size_t samples_ = 0, terms_ = 0;
  double x_[max_terms] = {};
  double y_[max_terms] = {};
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/refine/literal_refiner.inl"
#endif
