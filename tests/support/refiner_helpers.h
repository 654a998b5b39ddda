/// \file
/// A block that is fed by hand, and how close its coefficients must be.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "freqsynth/refine/least_squares_refiner.h"
#include "support/oracles.h"

namespace helpers {

using freqsynth::InverseList;
using freqsynth::LeastSquaresRefiner;
using freqsynth::max_terms;
using freqsynth::SequencePosition;
using Coefficients = std::array<float, max_terms>;

inline std::shared_ptr<const InverseList> shared_list() {
  static const auto list = std::make_shared<const InverseList>();
  return list;
}

/// A block that is fed by hand.
class Block {
 public:
  explicit Block(const LeastSquaresRefiner& refiner)
      : refiner_(&refiner), lines_(refiner.state_size() / 8) {
    refiner_->reset(state());
  }
  float add(std::vector<float> values) {
    return refiner_->absorb(state(), samples_++, values.data());
  }
  [[nodiscard]] Coefficients coefficients(std::size_t channel = 0) const {
    Coefficients out;
    refiner_->coefficients(lines_.data()->values, samples_, channel, out);
    return out;
  }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] const SequencePosition& next() const { return refiner_->list().position(samples_); }

 private:
  struct alignas(32) Line {
    float values[8];
  };
  float* state() { return lines_.data()->values; }

  const LeastSquaresRefiner* refiner_;
  std::vector<Line> lines_;
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
