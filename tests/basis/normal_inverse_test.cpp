// SPDX-License-Identifier: MIT
#include "freqsynth/basis/normal_inverse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::inverse_tolerance;
using oracle::Matrix;
using oracle::Real;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TermMatrix rounded(const Matrix& m) {
  TermMatrix result;
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (std::size_t j = 0; j < m.size(); ++j) result(i, j) = static_cast<double>(m(i, j));
  }
  return result;
}

Real relative_error(const TermMatrix& m, const Matrix& expected) {
  Matrix difference(expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t j = 0; j < expected.size(); ++j) {
      difference(i, j) = static_cast<Real>(m(i, j)) - expected(i, j);
    }
  }
  return difference.norm() / expected.norm();
}

void expect_zero_beyond(const TermMatrix& m, std::size_t size) {
  for (std::size_t i = 0; i < max_terms; ++i) {
    for (std::size_t j = 0; j < max_terms; ++j) {
      if (i >= size || j >= size) {
        ASSERT_EQ(m(i, j), 0) << i << ", " << j;
      }
    }
  }
}

/// A well-conditioned J: three times as many random samples as terms.
struct Problem {
  Problem(std::size_t terms, oracle::Random& random) : j(terms) {
    for (std::size_t n = 0; n < 3 * terms + 5; ++n) {
      const std::vector<double> a = sample(terms, random);
      j.add_outer(std::vector<Real>(a.begin(), a.end()));
    }
  }

  static std::vector<double> sample(std::size_t terms, oracle::Random& random) {
    std::vector<double> a(terms);
    for (double& value : a) value = random.uniform(-1, 1);
    return a;
  }

  Matrix j;
};

TEST(NormalInverse, RankOneUpdateIsTheInverseOfTheUpdatedMatrix) {
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    SCOPED_TRACE(terms);
    oracle::Random random(static_cast<unsigned>(terms));
    Matrix j = Problem(terms, random).j;
    TermMatrix normal = rounded(j);
    TermMatrix inverse = rounded(oracle::inverse(j));
    const std::vector<double> a = Problem::sample(terms, random);
    rank_one_update(inverse, normal, a, terms);

    j.add_outer(std::vector<Real>(a.begin(), a.end()));
    const Matrix expected = oracle::inverse(j);
    EXPECT_LT(relative_error(normal, j), 2 * oracle::double_rounding);
    EXPECT_LT(relative_error(inverse, expected), inverse_tolerance(j, expected));
    expect_zero_beyond(inverse, terms);
    expect_zero_beyond(normal, terms);

    // (J + a a^T)^-1 (J + a a^T) a = a, and the inverse of a symmetric matrix is symmetric.
    const auto bound = static_cast<double>(inverse_tolerance(j, expected));
    for (std::size_t i = 0; i < terms; ++i) {
      Real product = 0;
      for (std::size_t k = 0; k < terms; ++k) {
        Real ja = 0;
        for (std::size_t l = 0; l < terms; ++l) ja += j(k, l) * static_cast<Real>(a[l]);
        product += static_cast<Real>(inverse(i, k)) * ja;
        EXPECT_NEAR(inverse(i, k), inverse(k, i), bound * static_cast<double>(expected.norm()));
      }
      EXPECT_NEAR(static_cast<double>(product), a[i],
                  bound * std::sqrt(static_cast<double>(terms)));
    }
  }
}

TEST(NormalInverse, RankOneUpdateKeepsTheLargerNormalMatrix) {
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    SCOPED_TRACE(terms);
    oracle::Random random(static_cast<unsigned>(100 + terms));
    for (const std::size_t size : {terms, std::min(terms + 3, max_terms), max_terms}) {
      Matrix j = Problem(size, random).j;
      TermMatrix normal = rounded(j);
      TermMatrix inverse = rounded(oracle::inverse(j.leading(terms)));
      const std::vector<double> a = Problem::sample(size, random);
      rank_one_update(inverse, normal, a, terms);

      j.add_outer(std::vector<Real>(a.begin(), a.end()));
      const Matrix expected = oracle::inverse(j.leading(terms));
      EXPECT_LT(relative_error(normal, j), 2 * oracle::double_rounding);
      EXPECT_LT(relative_error(inverse, expected), inverse_tolerance(j.leading(terms), expected));
      expect_zero_beyond(normal, size);
    }
  }
}

TEST(NormalInverse, BorderInverseIsTheInverseOfTheBorderedMatrix) {
  for (std::size_t terms = 1; terms <= max_terms - 1; ++terms) {
    SCOPED_TRACE(terms);
    oracle::Random random(static_cast<unsigned>(200 + terms));
    const Matrix j = Problem(terms + 1, random).j;
    const Matrix old_inverse = oracle::inverse(j.leading(terms));
    TermMatrix inverse = rounded(old_inverse);
    std::vector<double> b(terms), step(terms);
    for (std::size_t i = 0; i < terms; ++i) b[i] = static_cast<double>(j(i, terms));
    const double delta = border_inverse(inverse, b, static_cast<double>(j(terms, terms)), step);

    const Matrix expected = oracle::inverse(j);
    const Real bound = inverse_tolerance(j, expected);
    EXPECT_LT(relative_error(inverse, expected), bound);
    expect_zero_beyond(inverse, terms + 1);
    // The corner of the inverse is 1 / Delta (eq. 37), the column above it step / Delta.
    const Real corner = expected(terms, terms);
    EXPECT_NEAR(static_cast<double>(static_cast<Real>(delta) * corner), 1,
                static_cast<double>(bound));
    for (std::size_t i = 0; i < terms; ++i) {
      Real expected_step = 0;
      for (std::size_t k = 0; k < terms; ++k) {
        expected_step -= old_inverse(i, k) * static_cast<Real>(b[k]);
      }
      EXPECT_NEAR(step[i], static_cast<double>(expected_step), static_cast<double>(bound));
      EXPECT_NEAR(inverse(i, terms), inverse(terms, i),
                  static_cast<double>(bound * expected.norm()));
    }
  }
}

TEST(NormalInverse, BorderInverseRefusesADependentTerm) {
  for (std::size_t terms = 1; terms <= max_terms - 1; ++terms) {
    SCOPED_TRACE(terms);
    oracle::Random random(static_cast<unsigned>(300 + terms));
    const Matrix j = Problem(terms, random).j;
    TermMatrix inverse = rounded(oracle::inverse(j));
    const TermMatrix before = inverse;
    // B = J c and D = c^T J c - 1 make Delta = -1.
    const std::vector<double> c = Problem::sample(terms, random);
    std::vector<double> b(terms), step(terms);
    Real d = -1;
    for (std::size_t i = 0; i < terms; ++i) {
      Real sum = 0;
      for (std::size_t k = 0; k < terms; ++k) sum += j(i, k) * static_cast<Real>(c[k]);
      b[i] = static_cast<double>(sum);
      d += static_cast<Real>(c[i]) * sum;
    }
    const double delta = border_inverse(inverse, b, static_cast<double>(d), step);
    EXPECT_NEAR(delta, -1, 1e-9);  // cancellation of numbers up to 1e4 with a condition below 1e2
    EXPECT_EQ(inverse.values, before.values);
    EXPECT_TRUE(
        std::isnan(border_inverse(inverse, b, std::numeric_limits<double>::quiet_NaN(), step)));
    EXPECT_EQ(inverse.values, before.values);
  }
}

/// Term values at (s, t), rounded to double: what both sides start from.
std::array<double, max_terms> terms_at(double s, double t) {
  const std::vector<Real> values = oracle::term_values(s, t);
  std::array<double, max_terms> a;
  for (std::size_t i = 0; i < max_terms; ++i) a[i] = static_cast<double>(values[i]);
  return a;
}

TEST(NormalInverse, FollowsTheDenseInverseThroughSamplesAndTerms) {
  oracle::Random random(1);
  NormalInverse normal;
  Matrix j(max_terms);
  EXPECT_EQ(normal.terms(), 0u);
  for (std::size_t n = 0; n < 300; ++n) {
    const auto a = terms_at(random.uniform(0, 1), random.uniform(0, 1));
    normal.add_sample(a);
    j.add_outer(std::vector<Real>(a.begin(), a.end()));
    ASSERT_EQ(normal.samples(), n + 1);
    if (n % 4 == 3 && normal.terms() < max_terms) {
      std::vector<double> step(normal.terms());
      const std::size_t terms = normal.terms();
      const double delta = normal.add_term(step);
      ASSERT_EQ(normal.terms(), delta > 0 ? terms + 1 : terms);
    }
    const Matrix leading = j.leading(normal.terms());
    const Matrix expected = oracle::inverse(leading);
    // Errors of earlier updates stay; Powell's form keeps them from growing.
    ASSERT_LT(relative_error(normal.inverse(), expected), 4 * inverse_tolerance(leading, expected))
        << n << " samples, " << normal.terms() << " terms";
  }
  EXPECT_EQ(normal.terms(), max_terms);
  EXPECT_LT(relative_error(normal.normal(), j), 300 * oracle::double_rounding);
}

TEST(NormalInverse, FirstSampleBringsInTheConstantTerm) {
  NormalInverse normal;
  normal.add_sample(terms_at(0.3, 0.9));
  EXPECT_EQ(normal.terms(), 1u);
  EXPECT_EQ(normal.inverse()(0, 0), 1);
  expect_zero_beyond(normal.inverse(), 1);
}

TEST(NormalInverse, TermThatTheSamplesDoNotDetermineIsNotAdded) {
  NormalInverse normal;
  std::vector<double> step(1);
  EXPECT_EQ(normal.add_term(step), 0) << "no sample";
  for (int n = 0; n < 5; ++n) {
    normal.add_sample(terms_at(0.3, 0.2 * n));
    const TermMatrix before = normal.inverse();
    EXPECT_EQ(normal.add_term(step), 0) << "all samples in one column";
    EXPECT_EQ(normal.terms(), 1u);
    EXPECT_EQ(normal.inverse().values, before.values);
  }
  normal.add_sample(terms_at(0.6, 0.5));
  EXPECT_GT(normal.add_term(step), 0);
  EXPECT_EQ(normal.terms(), 2u);
}

TEST(NormalInverse, ToleranceIsTheShareOfTheNewTermThatIsIndependent) {
  // Terms 1 and cos(pi s) at s = 0 and 1/3: values (1, 1), (1, 1/2), so D = 5/4, Delta = 1/8.
  for (const double tolerance : {0.09, 0.11}) {
    NormalInverse normal;
    normal.add_sample(terms_at(0, 0));
    normal.add_sample(terms_at(1.0 / 3, 0));
    std::vector<double> step(1);
    const double delta = normal.add_term(step, tolerance);
    if (tolerance < 0.1) {
      EXPECT_NEAR(delta, 0.125, 1e-15);
      EXPECT_NEAR(step[0], -0.75, 1e-15);
    } else {
      EXPECT_EQ(delta, 0);
    }
  }
}

TEST(NormalInverse, HasNo65thTerm) {
  NormalInverse normal;
  oracle::Random random(2);
  std::vector<double> step;
  for (int n = 0; n < 2000 && normal.terms() < max_terms; ++n) {
    normal.add_sample(terms_at(random.uniform(0, 1), random.uniform(0, 1)));
    step.resize(normal.terms());
    normal.add_term(step);
  }
  ASSERT_EQ(normal.terms(), max_terms);
  step.resize(max_terms);
  EXPECT_EQ(normal.add_term(step), 0);
}

TEST(NormalInverse, RefusesSizesThatDoNotFit) {
  TermMatrix inverse, normal;
  std::vector<double> a(65), step(65);
  const auto update = [&](std::size_t size, std::size_t terms) {
    rank_one_update(inverse, normal, std::span<const double>(a).first(size), terms);
  };
  EXPECT_THAT([&] { update(5, 0); }, ThrowsMessage<std::invalid_argument>(HasSubstr("terms is 0")));
  EXPECT_THAT([&] { update(5, 6); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("6"), HasSubstr("5"))));
  EXPECT_THAT([&] { update(65, 3); }, ThrowsMessage<std::invalid_argument>(HasSubstr("65")));
  const auto border = [&](std::size_t terms, std::size_t steps) {
    return border_inverse(inverse, std::span<const double>(a).first(terms), 1,
                          std::span<double>(step).first(steps));
  };
  EXPECT_THROW(border(0, 0), std::invalid_argument);
  EXPECT_THROW(border(64, 64), std::invalid_argument);
  EXPECT_THAT([&] { border(7, 6); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("7"), HasSubstr("6"))));
}

}  // namespace
}  // namespace freqsynth
