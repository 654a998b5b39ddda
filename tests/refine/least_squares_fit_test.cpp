// SPDX-License-Identifier: MIT
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/refine/least_squares_refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <vector>

#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using helpers::shared_list;
using oracle::float_rounding;
using oracle::Real;

/// One block, and all its samples.
class Fed {
 public:
  explicit Fed(const LeastSquaresRefiner& refiner)
      : refiner_(&refiner), state_(refiner.state_size()), values_(refiner.channels()) {
    refiner.reset(state_.data());
  }
  void add(const std::vector<float>& values) {
    const SequencePosition& position = refiner_->list().position(samples_);
    refiner_->absorb(state_.data(), samples_++, values.data());
    positions_.push_back(position);
    for (std::size_t c = 0; c < values.size(); ++c) values_[c].push_back(values[c]);
  }
  [[nodiscard]] const float* state() const { return state_.data(); }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] const std::vector<SequencePosition>& positions() const { return positions_; }
  [[nodiscard]] const std::vector<float>& values(std::size_t channel) const {
    return values_[channel];
  }

  /// Sum of the squared differences between the samples and their least squares fit of so many
  /// terms.
  [[nodiscard]] Real squared_residuals(std::size_t channel, std::size_t terms) const {
    oracle::LeastSquares fit;
    for (std::size_t i = 0; i < samples_; ++i) {
      fit.add(positions_[i].s, positions_[i].t, static_cast<Real>(values_[channel][i]));
    }
    const auto amplitudes = fit.amplitudes(terms);
    Real sum = 0;
    for (std::size_t i = 0; i < samples_; ++i) {
      const auto basis = oracle::term_values(positions_[i].s, positions_[i].t, terms);
      Real left = static_cast<Real>(values_[channel][i]);
      for (std::size_t k = 0; k < terms; ++k) left -= amplitudes[k] * basis[k];
      sum += left * left;
    }
    return sum;
  }
  [[nodiscard]] Real power(std::size_t channel) const {
    Real sum = 0;
    for (const float value : values_[channel]) {
      sum += static_cast<Real>(value) * static_cast<Real>(value);
    }
    return sum;
  }

 private:
  const LeastSquaresRefiner* refiner_;
  detail::AlignedVector<float> state_;
  std::vector<SequencePosition> positions_;
  std::vector<std::vector<float>> values_;
  std::size_t samples_ = 0;
};

class LeastSquaresFit : public testing::TestWithParam<InverseListSettings> {
 protected:
  SharedInverseList list_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(
    Lists, LeastSquaresFit,
    testing::Values(InverseListSettings{}, InverseListSettings{.samples_per_term = 3, .seed = 5},
                    InverseListSettings{.samples_per_term = 2, .max_terms = 10}));

TEST_P(LeastSquaresFit, FreedomIsTheSamplesThatTheTermsLeave) {
  const LeastSquaresRefiner refiner(list_, 1);
  EXPECT_EQ(refiner.freedom(0), 1);
  for (std::size_t n = 1; n <= 500; ++n) {
    const std::size_t terms = list_->terms(n - 1);
    ASSERT_EQ(refiner.terms(n), terms);
    const auto left = static_cast<double>(n) - static_cast<double>(terms);
    ASSERT_EQ(refiner.freedom(n), std::max(left, 1.0)) << n << " samples";
  }
}

TEST_P(LeastSquaresFit, ResidualIsWhatTheFitLeavesOver) {
  const std::vector<float> weights = {0.25f, 3};
  const LeastSquaresRefiner refiner(list_, 2, weights);
  Fed block(refiner);
  oracle::Random random(1);
  while (block.samples() < 330) {
    // Noise, and a function that the terms come to know.
    const SequencePosition& position = list_->position(block.samples());
    const auto smooth = static_cast<float>(2 + std::cos(3 * position.s) * position.t);
    block.add({random.value(), smooth});
    const std::size_t n = block.samples();
    if (n > 20 && n % 23 != 0) continue;
    const std::size_t terms = list_->terms(n - 1);
    Real weighted = 0;
    double bound = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const Real expected = block.squared_residuals(c, terms);
      // Each sample rounds what is left of its square a few times.
      const double own =
          2 * float_rounding * static_cast<double>(n + 16) * static_cast<double>(block.power(c));
      const float squares = refiner.squared_residuals(block.state(), c);
      ASSERT_NEAR(squares, static_cast<double>(expected), own) << n << " samples, channel " << c;
      ASSERT_GE(squares, 0);
      ASSERT_EQ(refiner.residual(block.state(), n, c), squares / refiner.freedom(n));
      weighted += static_cast<Real>(weights[c]) * expected;
      bound += double{weights[c]} * own;
    }
    ASSERT_NEAR(refiner.residual(block.state(), n) * refiner.freedom(n),
                static_cast<double>(weighted), bound);
  }
}

TEST_P(LeastSquaresFit, OfAFunctionOfTheFirstTermsNothingIsLeft) {
  const LeastSquaresRefiner refiner(list_, 1);
  Fed block(refiner);
  while (block.samples() < 300) {
    const auto basis = oracle::term_values(list_->position(block.samples()).s,
                                           list_->position(block.samples()).t, 10);
    Real value = 0;
    for (std::size_t i = 0; i < 10; ++i) value += basis[i] / static_cast<Real>(i + 1);
    block.add({static_cast<float>(value)});
  }
  EXPECT_LT(refiner.residual(block.state(), 300), 1e-6);
  EXPECT_GE(refiner.residual(block.state(), 300), 0);
}

TEST_P(LeastSquaresFit, ResidualOfManyLargestValuesIsTheirVariance) {
  const LeastSquaresRefiner refiner(list_, 1, {1});
  detail::AlignedVector<float> state(refiner.state_size());
  refiner.reset(state.data());
  for (std::size_t n = 1; n <= 30000; ++n) {
    const float value = n % 2 == 0 ? most_state_value : -most_state_value;
    refiner.absorb(state.data(), n - 1, &value);
    ASSERT_FLOAT_EQ(refiner.residual(state.data(), n), refiner.residual(state.data(), n, 0))
        << n << " samples";
  }
}

TEST_P(LeastSquaresFit, PixelSumsAreTheSharesOfTheSamples) {
  const LeastSquaresRefiner refiner(list_, 2);
  Fed block(refiner);
  oracle::Random random(2);
  // Of one axis: the part in a pixel of an interval around the point, as long as the distance to
  // its neighbours times 0.85, but at most a pixel. What is beyond the block counts for no pixel,
  // and of samples on its border half is left out.
  const auto share = [](double s, float spacing, int pixel) {
    const Real half = std::min(Real{1}, Real{0.85} * 8 * spacing) / 2;
    const Real begin = std::max(8 * Real{s} - half, Real(pixel));
    const Real end = std::min(8 * Real{s} + half, Real(pixel + 1));
    return std::max(end - begin, Real{0}) / (2 * half);
  };
  while (block.samples() < 600) {
    block.add({random.value(), 100 * random.value()});
    if (block.samples() % 97 != 0) continue;
    for (std::size_t c = 0; c < 2; ++c) {
      const auto sums = refiner.pixel_sums(block.state(), c);
      for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
          Real expected = 0, magnitude = 0;
          for (std::size_t i = 0; i < block.samples(); ++i) {
            const SequencePosition& position = block.positions()[i];
            const auto inside = [](double s) { return s > 0 && s < 1; };
            const Real counts = inside(position.s) && inside(position.t) ? 1 : Real{0.5};
            const Real part = counts * share(position.s, position.spacing, x) *
                              share(position.t, position.spacing, y) *
                              static_cast<Real>(block.values(c)[i]);
            expected += part;
            magnitude += std::abs(part);
          }
          ASSERT_NEAR(sums[static_cast<std::size_t>(8 * y + x)], static_cast<double>(expected),
                      32 * float_rounding * static_cast<double>(magnitude))
              << "pixel " << x << ", " << y;
        }
      }
    }
  }
}

TEST_P(LeastSquaresFit, OwnSumsAndSpreadAreThoseOfTheSamplesInsidePixels) {
  const LeastSquaresRefiner refiner(list_, 2);
  Fed block(refiner);
  oracle::Random random(5);
  while (block.samples() < 600) {
    block.add({random.value(), 100 * random.value()});
    if (block.samples() % 97 != 0) continue;
    for (std::size_t c = 0; c < 2; ++c) {
      std::array<Real, max_terms> sums = {}, magnitudes = {};
      std::array<int, max_terms> counts = {};
      Real spread = 0;
      for (std::size_t i = 0; i < block.samples(); ++i) {
        const double x = 8 * block.positions()[i].s, y = 8 * block.positions()[i].t;
        if (x == std::floor(x) || y == std::floor(y)) continue;
        const auto pixel = static_cast<std::size_t>(8 * std::floor(y) + std::floor(x));
        const auto value = static_cast<Real>(block.values(c)[i]);
        if (counts[pixel] > 0) {
          spread = std::max(spread, std::abs(value - sums[pixel] / counts[pixel]));
        }
        sums[pixel] += value;
        magnitudes[pixel] += std::abs(value);
        ++counts[pixel];
      }
      const auto own = refiner.own_sums(block.state(), c);
      Real greatest = 0;
      for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
        ASSERT_NEAR(own[pixel], static_cast<double>(sums[pixel]),
                    32 * float_rounding * static_cast<double>(magnitudes[pixel]));
        greatest = std::max(greatest, magnitudes[pixel]);
      }
      ASSERT_NEAR(refiner.spread(block.state(), c), static_cast<double>(spread),
                  32 * float_rounding * static_cast<double>(greatest));
    }
  }
}

TEST_P(LeastSquaresFit, FitIsAllOfThis) {
  const LeastSquaresRefiner refiner(list_, 3);
  Fed block(refiner);
  oracle::Random random(3);
  for (int n = 0; n <= 200; ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      const BlockFit fit = refiner.fit(block.state(), block.samples(), c);
      std::array<float, max_terms> coefficients;
      refiner.coefficients(block.state(), block.samples(), c, coefficients);
      ASSERT_EQ(fit.coefficients, coefficients);
      ASSERT_EQ(fit.residual, refiner.residual(block.state(), block.samples(), c));
      ASSERT_EQ(fit.pixel_sums.data(), refiner.pixel_sums(block.state(), c).data());
      ASSERT_EQ(fit.own_sums.data(), refiner.own_sums(block.state(), c).data());
      ASSERT_EQ(fit.spread, refiner.spread(block.state(), c));
      if (n == 0) {
        ASSERT_EQ(coefficients, (std::array<float, max_terms>{}));
        ASSERT_EQ(fit.residual, 0);
      }
    }
    block.add({random.value(), 2 * random.value(), 3 * random.value()});
  }
}

TEST_P(LeastSquaresFit, OfAChannelWithoutAUsableValueIsZero) {
  const LeastSquaresRefiner refiner(list_, 2);
  Fed block(refiner);
  oracle::Random random(4);
  for (int n = 0; n < 60; ++n) {
    block.add({random.value(), n % 2 == 0 ? std::bit_cast<float>(0x7fc00000u) : 2e36f});
    const BlockFit fit = refiner.fit(block.state(), block.samples(), 1);
    ASSERT_EQ(fit.coefficients, (std::array<float, max_terms>{}));
    ASSERT_EQ(fit.residual, 0);
    for (const float sum : fit.pixel_sums) ASSERT_EQ(sum, 0);
    ASSERT_NE(refiner.fit(block.state(), block.samples(), 0).coefficients[0], 0);
  }
}

TEST_P(LeastSquaresFit, VariancesOfTermsInTheFitAreThoseOfLeastSquares) {
  const LeastSquaresRefiner refiner(list_, 1);
  oracle::Matrix normal(max_terms);
  for (std::size_t n = 1; n <= 400; ++n) {
    normal.add_outer(oracle::term_values(list_->position(n - 1).s, list_->position(n - 1).t));
    if (n > 20 && n % 19 != 0) continue;
    const std::size_t terms = refiner.terms(n);
    const oracle::Matrix inverse = oracle::inverse(normal.leading(terms));
    for (std::size_t i = 0; i < terms; ++i) {
      const auto expected = static_cast<double>(inverse(i, i) / std::pow(oracle::amplitude(i), 2));
      ASSERT_NEAR(refiner.variances(n)[i], expected, 1e-6 * expected)
          << n << " samples, term " << i;
    }
  }
}

TEST_P(LeastSquaresFit, VariancesOfOtherTermsAreThoseOfAnEdge) {
  const LeastSquaresRefiner refiner(list_, 1);
  const auto energy = [](int u, int v) {
    return std::pow(static_cast<Real>(u * u + v * v), Real{-1.5});
  };
  for (std::size_t n = 1; n <= 200; n += n < 20 ? 1 : 9) {
    // What the fit does not hold, up to frequencies that do not matter, has the energy of the
    // residuals: 64 times their variance, by Parseval.
    std::array<std::array<bool, 64>, 64> in_fit{};
    for (std::size_t i = 0; i < refiner.terms(n); ++i) {
      in_fit[static_cast<std::size_t>(oracle::vertical(i))]
            [static_cast<std::size_t>(oracle::horizontal(i))] = true;
    }
    Real rest = 0;
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 64; ++u) {
        if (!in_fit[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)]) rest += energy(u, v);
      }
    }
    for (std::size_t i = refiner.terms(n); i < max_terms; ++i) {
      const auto expected =
          static_cast<double>(64 * energy(oracle::horizontal(i), oracle::vertical(i)) / rest);
      ASSERT_NEAR(refiner.variances(n)[i], expected, 1e-6 * expected)
          << n << " samples, term " << i;
    }
  }
}

}  // namespace
}  // namespace freqsynth
