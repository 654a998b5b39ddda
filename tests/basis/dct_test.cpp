// SPDX-License-Identifier: MIT
#include "freqsynth/basis/dct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::float_rounding;
using oracle::Real;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Block = std::array<float, max_terms>;

/// cos((2 x + 1) u pi / 16), eq. 7.
Real pixel_cosine(std::size_t x, std::size_t u) {
  return std::cos(static_cast<Real>((2 * x + 1) * u) * oracle::pi / 16);
}

/// Eq. 1, all four sums, for the coefficient with frequencies u and v.
Real literal_forward(const Block& pixels, std::size_t u, std::size_t v) {
  Real sum = 0;
  for (std::size_t x = 0; x < 8; ++x) {
    for (std::size_t y = 0; y < 8; ++y) {
      sum += static_cast<Real>(pixels[y * 8 + x]) * pixel_cosine(x, u) * pixel_cosine(y, v);
    }
  }
  return sum * oracle::kappa(static_cast<int>(u)) * oracle::kappa(static_cast<int>(v)) / 4;
}

/// Eq. 2 (eq. 34 for fewer terms) at pixel (x, y).
Real literal_inverse(const Block& coefficients, std::size_t x, std::size_t y, std::size_t terms) {
  Real sum = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    sum += oracle::amplitude(i) * static_cast<Real>(coefficients[i]) *
           pixel_cosine(x, static_cast<std::size_t>(oracle::horizontal(i))) *
           pixel_cosine(y, static_cast<std::size_t>(oracle::vertical(i)));
  }
  return sum;
}

double sum_of_magnitudes(const Block& values) {
  double sum = 0;
  for (const float value : values) sum += std::abs(double{value});
  return sum;
}

// A pixel is a sum of 64 products of three floats, added 8 + 8 at a time: each product is rounded
// at most 3 + 2 times and takes part in at most 7 + 7 additions, and no amplitude exceeds 1/4.
double inverse_tolerance(const Block& coefficients) {
  return 19 * float_rounding * sum_of_magnitudes(coefficients) / 4;
}

TEST(Dct, ZigZagIsTheTableOfTheJpegStandard) {
  for (std::size_t i = 0; i < max_terms; ++i) {
    EXPECT_EQ(frequency_of_term(i).u, oracle::horizontal(i)) << "term " << i;
    EXPECT_EQ(frequency_of_term(i).v, oracle::vertical(i)) << "term " << i;
  }
}

TEST(Dct, ZigZagDirectionsAreInverse) {
  for (std::size_t u = 0; u < 8; ++u) {
    for (std::size_t v = 0; v < 8; ++v) {
      const std::size_t term = term_of_frequency(u, v);
      ASSERT_LT(term, max_terms);
      EXPECT_EQ(frequency_of_term(term).u, u);
      EXPECT_EQ(frequency_of_term(term).v, v);
    }
  }
}

TEST(Dct, AmplitudeOfCoefficientIsEquation6) {
  for (std::size_t i = 0; i < max_terms; ++i) {
    EXPECT_DOUBLE_EQ(amplitude_of_coefficient(i), static_cast<double>(oracle::amplitude(i)));
  }
}

// The argument pi u s of a cosine is at most 7 pi |s| with two roundings, the product of two
// cosines doubles the error.
double term_tolerance(double reach) {
  return 2 * (7 * 3.15 * reach * 3 + 2) * oracle::double_rounding;
}

TEST(Dct, TermsAreProductsOfCosines) {
  oracle::Random random(1);
  std::vector<std::pair<double, double>> points = {{0, 0},   {1, 0},     {0, 1},    {1, 1},
                                                   {0.5, 0}, {0.5, 0.5}, {1, 0.75}, {0.125, 1}};
  for (int i = 0; i < 500; ++i) points.push_back({random.uniform(0, 1), random.uniform(0, 1)});
  for (const auto& [s, t] : points) {
    std::array<double, max_terms> values;
    evaluate_terms(s, t, values);
    const std::vector<Real> expected = oracle::term_values(s, t);
    for (std::size_t i = 0; i < max_terms; ++i) {
      ASSERT_NEAR(values[i], static_cast<double>(expected[i]), term_tolerance(1))
          << "term " << i << " at " << s << ", " << t;
    }
  }
}

TEST(Dct, FewerTermsAreTheFirstOnes) {
  std::array<double, max_terms> all;
  evaluate_terms(0.3, 0.8, all);
  for (std::size_t count = 0; count <= max_terms; ++count) {
    std::vector<double> some(count);
    evaluate_terms(0.3, 0.8, some);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(some[i], all[i]);
  }
}

TEST(Dct, TermsBeyondTheBlockAreItsEvenPeriodicExtension) {
  oracle::Random random(2);
  for (int n = 0; n < 100; ++n) {
    const double s = random.uniform(0, 1);
    const double t = random.uniform(0, 1);
    std::array<double, max_terms> inside, outside;
    evaluate_terms(s, t, inside);
    for (const auto& [x, y] : {std::pair{-s, t}, {s, -t}, {2 - s, t}, {2 + s, 2 - t}}) {
      evaluate_terms(x, y, outside);
      for (std::size_t i = 0; i < max_terms; ++i) {
        // 2 - s is itself rounded: one more rounding of a number up to 3.
        ASSERT_NEAR(outside[i], inside[i], 2 * term_tolerance(3));
      }
    }
  }
}

TEST(Dct, ForwardIsEquation1) {
  oracle::Random random(3);
  for (int n = 0; n < 20; ++n) {
    const auto pixels = random.values<64>();
    Block coefficients;
    forward_dct(pixels, coefficients);
    // Cosines rounded to float on both axes, and the result.
    const double tolerance = 3 * float_rounding * sum_of_magnitudes(pixels) / 4;
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Real expected = literal_forward(pixels, static_cast<std::size_t>(oracle::horizontal(i)),
                                            static_cast<std::size_t>(oracle::vertical(i)));
      ASSERT_NEAR(coefficients[i], static_cast<double>(expected), tolerance);
    }
  }
}

TEST(Dct, InverseIsEquation2AndEquation34) {
  oracle::Random random(4);
  const auto coefficients = random.values<64>();
  const double tolerance = inverse_tolerance(coefficients);
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    Block pixels;
    inverse_dct(coefficients, pixels, terms);
    for (std::size_t y = 0; y < 8; ++y) {
      for (std::size_t x = 0; x < 8; ++x) {
        ASSERT_NEAR(pixels[y * 8 + x],
                    static_cast<double>(literal_inverse(coefficients, x, y, terms)), tolerance)
            << terms << " terms";
      }
    }
  }
}

TEST(Dct, AllTermsAreTheDefaultOfTheInverse) {
  oracle::Random random(5);
  const auto coefficients = random.values<64>();
  Block some, all;
  inverse_dct(coefficients, some);
  inverse_dct(coefficients, all, max_terms);
  EXPECT_EQ(some, all);
}

TEST(Dct, ForwardUndoesInverse) {
  oracle::Random random(7);
  for (int n = 0; n < 20; ++n) {
    const auto coefficients = random.values<64>();
    Block pixels, again;
    inverse_dct(coefficients, pixels);
    forward_dct(pixels, again);
    // Every pixel's error enters a coefficient with a factor of at most 1/4; errors of both ways
    // add.
    const double tolerance = 64 / 4 * inverse_tolerance(coefficients) +
                             3 * float_rounding * sum_of_magnitudes(pixels) / 4;
    for (std::size_t i = 0; i < max_terms; ++i) {
      ASSERT_NEAR(again[i], coefficients[i], tolerance);
    }
  }
}

TEST(Dct, EnergyIsConserved) {
  oracle::Random random(8);
  const auto pixels = random.values<64>();
  Block coefficients;
  forward_dct(pixels, coefficients);
  double energy = 0, transformed = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    energy += std::pow(double{pixels[i]}, 2);
    transformed += std::pow(double{coefficients[i]}, 2);
  }
  // Twice the relative error of the coefficients' norm, 64 errors of one coefficient at most.
  const double error = 8 * 3 * float_rounding * sum_of_magnitudes(pixels) / 4;
  EXPECT_NEAR(transformed, energy, 2 * error * std::sqrt(energy) + error * error);
}

TEST(Dct, ConstantBlockHasOneCoefficient) {
  Block pixels, coefficients;
  pixels.fill(3);
  forward_dct(pixels, coefficients);
  EXPECT_FLOAT_EQ(coefficients[0], 24);
  for (std::size_t i = 1; i < max_terms; ++i) {
    EXPECT_NEAR(coefficients[i], 0, 3 * float_rounding * 64 * 3 / 4);
  }
}

TEST(Dct, BlockAtPixelCentresIsTheInverseTransform) {
  oracle::Random random(9);
  const auto coefficients = random.values<64>();
  Block pixels;
  inverse_dct(coefficients, pixels);
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 0; x < 8; ++x) {
      const double s = (static_cast<double>(x) + 0.5) / 8;
      const double t = (static_cast<double>(y) + 0.5) / 8;
      ASSERT_NEAR(evaluate_block(coefficients, s, t), pixels[y * 8 + x],
                  inverse_tolerance(coefficients));
    }
  }
}

TEST(Dct, BlockAtAnyPointIsTheSumOfItsTerms) {
  oracle::Random random(10);
  const auto coefficients = random.values<64>();
  for (int n = 0; n < 200; ++n) {
    const double s = random.uniform(0, 1);
    const double t = random.uniform(0, 1);
    ASSERT_NEAR(
        evaluate_block(coefficients, s, t),
        static_cast<double>(oracle::block_value(coefficients, s, t)),
        (term_tolerance(1) + 64 * oracle::double_rounding) * sum_of_magnitudes(coefficients) / 4);
  }
}

TEST(Dct, InverseRefusesInvalidNumbersOfTerms) {
  Block coefficients{}, pixels{};
  EXPECT_THAT([&] { inverse_dct(coefficients, pixels, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("terms is 0")));
  EXPECT_THAT([&] { inverse_dct(coefficients, pixels, 65); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("terms is 65")));
}

}  // namespace
}  // namespace freqsynth
