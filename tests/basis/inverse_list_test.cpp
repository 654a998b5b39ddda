// SPDX-License-Identifier: MIT
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/sample_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Matrix;
using oracle::Real;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

InverseListSettings at_rate(double samples_per_term) {
  InverseListSettings settings;
  settings.samples_per_term = samples_per_term;
  return settings;
}

/// Walks the list and keeps J of all 64 terms, summed up anew from the positions.
void walk(const InverseList& list, std::size_t count,
          const std::function<void(std::size_t, const Matrix&)>& visit) {
  Matrix j(max_terms);
  for (std::size_t index = 0; index < count; ++index) {
    j.add_outer(oracle::term_values(list.position(index).s, list.position(index).t));
    visit(index, j);
  }
}

/// Largest eigenvalue, approached from below by power iteration.
double largest_eigenvalue(const Matrix& m) {
  const std::size_t n = m.size();
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 1 + 0.01 * static_cast<double>(i);
  double estimate = 0;
  for (int step = 0; step < 60; ++step) {
    std::vector<double> y(n);
    double length = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) y[i] += static_cast<double>(m(i, j)) * x[j];
      length += y[i] * y[i];
    }
    estimate = std::sqrt(length);
    for (std::size_t i = 0; i < n; ++i) x[i] = y[i] / estimate;
  }
  return estimate;
}

/// Certain, whatever the power iteration found: all eigenvalues lie between bound / limit and
/// bound.
bool condition_below(const Matrix& m, double limit) {
  const double bound = 1.03 * largest_eigenvalue(m);
  return oracle::positive_definite(m, -1, bound) && oracle::positive_definite(m, 1, -bound / limit);
}

Real relative_error(std::span<const double> packed, const Matrix& expected) {
  Matrix difference(expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Real value = static_cast<Real>(packed[i * (i + 1) / 2 + j]);
      difference(i, j) = value - expected(i, j);
      difference(j, i) = value - expected(j, i);
    }
  }
  return difference.norm() / expected.norm();
}

/// Entries for which a slow check is made: those where a term comes in, and every fourth one.
bool chosen(const InverseList& list, std::size_t index) {
  return !list.border(index).empty() || index % 4 == 3;
}

class AtUsualRates : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Rates, AtUsualRates, testing::Values(2, 2.5, 3));

TEST_P(AtUsualRates, ConditionNumberStaysBelow15) {
  const InverseList list(at_rate(GetParam()));
  walk(list, 1024, [&](std::size_t index, const Matrix& j) {
    if (!chosen(list, index)) return;
    ASSERT_TRUE(condition_below(j.leading(list.terms(index)), 15)) << "index " << index;
  });
}

TEST_P(AtUsualRates, InverseIsTheDenseInverseOfTheWholeList) {
  const InverseList list(at_rate(GetParam()));
  walk(list, 1024, [&](std::size_t index, const Matrix& j) {
    const std::size_t terms = list.terms(index);
    ASSERT_EQ(list.inverse(index).size(), terms * (terms + 1) / 2);
    if (!chosen(list, index)) return;
    const Matrix expected = oracle::inverse(j.leading(terms));
    // 1.7e-15 was measured; other compilers round in another order.
    ASSERT_LT(relative_error(list.inverse(index), expected), 5e-15L) << "index " << index;
  });
}

TEST_P(AtUsualRates, TermsFollowTheSchedule) {
  const double rate = GetParam();
  const InverseList list(at_rate(rate));
  EXPECT_EQ(list.terms(0), 1u);
  std::vector<std::size_t> added;
  for (std::size_t index = 1; index < 256; ++index) {
    const std::size_t more = list.terms(index) - list.terms(index - 1);
    ASSERT_LE(more, 1u);
    if (more == 1) added.push_back(index);
  }
  ASSERT_EQ(added.size(), max_terms - 1);
  EXPECT_EQ(list.terms(1024), max_terms);
  EXPECT_NEAR(static_cast<double>(added[0]), rate, 1);
  for (std::size_t k = 0; k + 1 < added.size(); ++k) {
    const std::size_t gap = added[k + 1] - added[k];
    if (rate == 2.5) {
      // Alternately 2 and 3.
      EXPECT_TRUE(gap == 2 || gap == 3);
      if (k > 0) {
        EXPECT_EQ(gap + (added[k] - added[k - 1]), 5u) << "term " << k;
      }
    } else {
      EXPECT_EQ(static_cast<double>(gap), rate);
    }
  }
}

/// Gains and bordering vectors are what eqs. 25 and 37 say, from the dense inverse.
void expect_derived_vectors(const InverseList& list, std::size_t count, Real relative) {
  walk(list, count, [&](std::size_t index, const Matrix& j) {
    if (!chosen(list, index)) return;
    const std::size_t terms = list.gain(index).size();
    const Matrix inverse = oracle::inverse(j.leading(terms));
    const auto a = oracle::term_values(list.position(index).s, list.position(index).t, terms);
    const Real bound = relative * inverse.norm();
    const bool bordered = !list.border(index).empty();
    ASSERT_EQ(list.terms(index), terms + (bordered ? 1 : 0));
    if (bordered) {
      ASSERT_EQ(list.border(index).size(), terms);
    }
    for (std::size_t i = 0; i < terms; ++i) {
      Real gain = 0, border = 0, b_norm = 0;
      for (std::size_t k = 0; k < terms; ++k) {
        gain += inverse(i, k) * a[k];
        if (!bordered) continue;
        border -= inverse(i, k) * j(k, terms);
        b_norm += std::abs(j(k, terms));
      }
      ASSERT_NEAR(list.gain(index)[i], static_cast<double>(gain),
                  static_cast<double>(bound * static_cast<Real>(terms)))
          << "index " << index;
      if (bordered) {
        ASSERT_NEAR(list.border(index)[i], static_cast<double>(border),
                    static_cast<double>(bound * (b_norm + 1)))
            << "index " << index;
      }
    }
  });
}

TEST_P(AtUsualRates, GainAndBorderFollowFromTheInverse) {
  InverseListSettings settings = at_rate(GetParam());
  // 2.1e-16 was measured.
  expect_derived_vectors(InverseList(settings), 400, 4e-16L);
  settings.positions = SamplePositions::lattice;
  // 6e-17 was measured.
  expect_derived_vectors(InverseList(settings), 400, 2e-16L);
}

TEST(InverseList, RowsAreTheGainsRoundedToFloat) {
  const InverseList list;
  for (std::size_t index = 0; index < 200; ++index) {
    const detail::SampleRow& row = list.row(index);
    const auto gain = list.gain(index);
    ASSERT_EQ(row.terms, gain.size());
    std::array<double, max_terms> terms;
    evaluate_terms(list.position(index).s, list.position(index).t, terms);
    for (std::size_t i = 0; i < max_terms; ++i) {
      const auto term = static_cast<float>(terms[i]);
      ASSERT_EQ(row.gain[i], i < gain.size() ? static_cast<float>(gain[i]) : term);
      ASSERT_EQ(row.fit[i], i < gain.size() ? term : 0.0f);
      ASSERT_EQ(row.term(i), term);
    }
    ASSERT_EQ(row.border != nullptr, !list.border(index).empty());
  }
}

TEST(InverseList, RowsThatLieSideBySideAreThoseOfTheirIndices) {
  const InverseList list;
  for (const std::size_t most : {1u, 2u, 7u, 64u, 200u}) {
    for (std::size_t index = 0; index < 200;) {
      const auto rows = list.rows(index, most);
      ASSERT_GE(rows.size(), 1u);
      ASSERT_LE(rows.size(), most);
      for (const detail::SampleRow& row : rows) ASSERT_EQ(&row, &list.row(index++));
    }
  }
}

class AtLowRates : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Rates, AtLowRates, testing::Values(1, 1.3, 1.7));

TEST_P(AtLowRates, TermsWaitUntilTheSamplesDetermineThem) {
  InverseListSettings settings = at_rate(GetParam());
  // With a term a sample the bent lattice passes through a matrix that is almost singular, whose
  // rounding the later ones inherit (1e-10 of J^-1).
  if (GetParam() == 1) settings.positions = SamplePositions::lattice;
  const InverseList list(settings);
  std::size_t before = 1;
  walk(list, 600, [&](std::size_t index, const Matrix& j) {
    const std::size_t terms = list.terms(index);
    ASSERT_LE(terms, index + 1) << "more unknowns than samples";
    ASSERT_GE(terms, before);
    ASSERT_LE(terms, before + 1);
    before = terms;
    for (const double value : list.inverse(index)) ASSERT_TRUE(std::isfinite(value));
    for (const double value : list.gain(index)) ASSERT_TRUE(std::isfinite(value));
    if (!chosen(list, index)) return;
    const Matrix leading = j.leading(terms);
    const Matrix expected = oracle::inverse(leading);
    ASSERT_LT(relative_error(list.inverse(index), expected),
              oracle::inverse_tolerance(leading, expected))
        << "index " << index;
  });
  EXPECT_EQ(list.terms(600), max_terms);
}

TEST(InverseList, ATermIsDeferredAtOneSamplePerTerm) {
  // The fourth term, cos(2 pi t), is 1 at all four corners like the constant one.
  const InverseList list(at_rate(1));
  EXPECT_EQ(list.terms(2), 3u);
  EXPECT_EQ(list.terms(3), 3u);
  EXPECT_EQ(list.terms(4), 4u);
}

TEST(InverseList, LargestNumberOfTermsIsASetting) {
  InverseListSettings settings;
  for (const std::size_t most : {std::size_t{1}, std::size_t{10}, std::size_t{63}}) {
    settings.max_terms = most;
    EXPECT_EQ(InverseList(settings).terms(500), most);
  }
}

TEST(InverseList, PositionsAreTheSequenceOfTheSeed) {
  InverseListSettings settings;
  settings.seed = 77;
  const InverseList list(settings);
  SampleSequence sequence(77);
  for (std::size_t index = 0; index < 500; ++index) {
    EXPECT_EQ(list.position(index).s, sequence[index].s);
    EXPECT_EQ(list.position(index).t, sequence[index].t);
    EXPECT_EQ(list.position(index).partner, sequence[index].partner);
  }
  EXPECT_EQ(list.settings().seed, 77u);
}

TEST(InverseList, WrongSettingsAreNamed) {
  const auto refuses_rate = [](double rate, const char* value) {
    EXPECT_THAT([&] { InverseList{at_rate(rate)}; },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr("samples_per_term"), HasSubstr(value))));
  };
  refuses_rate(0.5, "0.5");
  refuses_rate(-2, "-2");
  refuses_rate(std::numeric_limits<double>::infinity(), "inf");
  refuses_rate(std::numeric_limits<double>::quiet_NaN(), "nan");
  for (const std::size_t most : {std::size_t{0}, std::size_t{65}}) {
    InverseListSettings settings;
    settings.max_terms = most;
    EXPECT_THAT([&] { InverseList{settings}; },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr("max_terms"), HasSubstr(std::to_string(most)))));
  }
}

TEST(InverseList, RefusesIndicesBeyondTheSequence) {
  const InverseList list;
  EXPECT_THROW(list.reserve(SampleSequence::max_size + 1), std::invalid_argument);
  for (const std::size_t index :
       {SampleSequence::max_size, std::numeric_limits<std::size_t>::max()}) {
    EXPECT_THROW(static_cast<void>(list.position(index)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(list.terms(index)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(list.inverse(index)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(list.gain(index)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(list.border(index)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(list.row(index)), std::invalid_argument);
  }
  EXPECT_EQ(list.size(), 0u);
}

}  // namespace
}  // namespace freqsynth
