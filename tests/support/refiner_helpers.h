// SPDX-License-Identifier: MIT
/// \file
/// A block that is fed by hand, and how close its coefficients must be.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "support/oracles.h"

namespace helpers {

using freqsynth::InverseList;
using freqsynth::LeastSquaresRefiner;
using freqsynth::max_terms;
using freqsynth::SequencePosition;
using freqsynth::SharedInverseList;
using Coefficients = std::array<float, max_terms>;

inline SharedInverseList shared_list() {
  static const SharedInverseList list(freqsynth::InverseListSettings{});
  return list;
}

/// A block that is fed by hand.
class Block {
 public:
  explicit Block(const LeastSquaresRefiner& refiner)
      : refiner_(&refiner), state_(refiner.state_size()) {
    refiner_->reset(state_.data());
  }
  float add(std::vector<float> values) {
    return refiner_->absorb(state_.data(), samples_++, values.data());
  }
  [[nodiscard]] Coefficients coefficients(std::size_t channel = 0) const {
    Coefficients out;
    refiner_->coefficients(state_.data(), samples_, channel, out);
    return out;
  }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] const SequencePosition& next() const { return refiner_->list().position(samples_); }

 private:
  const LeastSquaresRefiner* refiner_;
  freqsynth::detail::AlignedVector<float> state_;
  std::size_t samples_ = 0;
};

/// Allowed error of an amplitude after n samples of magnitude up to 1. Every sample rounds state,
/// gain and prediction a few times, and the fit never enlarges an older error: at worst they add
/// up.
inline double tolerance(std::size_t samples) {
  return 4 * oracle::float_rounding * static_cast<double>(samples + 16);
}

inline void expect_near(const Coefficients& actual, const std::vector<oracle::Real>& expected,
                        double bound) {
  for (std::size_t i = 0; i < max_terms; ++i) {
    const auto amplitude = static_cast<double>(oracle::amplitude(i));
    ASSERT_NEAR(amplitude * actual[i], amplitude * static_cast<double>(expected[i]), bound)
        << "term " << i;
  }
}

inline std::vector<oracle::Real> widened(const Coefficients& values) {
  return {values.begin(), values.end()};
}

}  // namespace helpers
