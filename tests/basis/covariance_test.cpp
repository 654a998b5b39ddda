// SPDX-License-Identifier: MIT
#include "freqsynth/basis/covariance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/basis/box_covariance.h"
#include "support/covariance_oracle.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using detail::BoxCovariance;
using detail::CovarianceFunction;
using oracle::Real;

TEST(CovarianceMathematics, IsThatOfTheStandardLibrary) {
  double worst = 0;
  for (double x = 0; x < 650; x += 0.01237) {
    worst = std::max(
        worst, static_cast<double>(std::abs(Real{detail::exp_minus(x)} / std::exp(-Real{x}) - 1)));
  }
  EXPECT_LT(worst, 4 * oracle::double_rounding);
  EXPECT_EQ(detail::exp_minus(0), 1);
  EXPECT_EQ(detail::exp_minus(1e9), 0);
  EXPECT_EQ(detail::exp_minus(std::numeric_limits<double>::infinity()), 0);
  worst = 0;
  for (double turns = -4; turns < 4; turns += 0.000137) {
    worst = std::max(worst, static_cast<double>(std::abs(Real{detail::cos_turns(turns)} -
                                                         std::cos(2 * oracle::pi * turns))));
  }
  EXPECT_LT(worst, 4 * oracle::double_rounding);
  EXPECT_EQ(detail::cos_turns(0), 1);
  EXPECT_EQ(detail::cos_turns(0.5), -1);
  worst = 0;
  for (double x = 1e-12; x < 1e12; x *= 1.00137) {
    const Real truth = std::log(Real{x});
    worst = std::max(worst, static_cast<double>(std::abs(detail::log_of(x) - truth) /
                                                std::max(Real{1}, std::abs(truth))));
  }
  EXPECT_LT(worst, 6 * oracle::double_rounding);
  EXPECT_EQ(detail::log_of(1), 0);
}

TEST(Covariance, IsItsFormula) {
  oracle::Random random(1);
  for (const Covariance& covariance : oracle::covariances()) {
    const CovarianceFunction function(covariance);
    EXPECT_EQ(function({0, 0}), 1);
    for (int i = 0; i < 200; ++i) {
      const UnitPoint d{random.uniform(-2, 2), random.uniform(-2, 2)};
      const Real truth = oracle::covariance(covariance, d.s, d.t);
      EXPECT_NEAR(function(d), static_cast<double>(truth), 1e-14) << oracle::name(covariance);
      EXPECT_EQ(function(d), function({-d.s, -d.t}));
      EXPECT_LE(std::abs(function(d)), 1);
    }
  }
}

TEST(Covariance, OfManyDifferencesIsThatOfEach) {
  oracle::Random random(2);
  std::vector<double> s(601), t(s.size()), values(s.size());
  for (std::size_t i = 0; i < s.size(); ++i) {
    s[i] = random.uniform(-3, 3);
    t[i] = random.uniform(-3, 3);
  }
  for (const Covariance& covariance : oracle::covariances()) {
    const CovarianceFunction function(covariance);
    for (const std::size_t count : {std::size_t{1}, std::size_t{255}, s.size()}) {
      function.values(s.data(), t.data(), count, values.data());
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(values[i], function({s[i], t[i]})) << oracle::name(covariance);
      }
    }
  }
}

TEST(Covariance, ReachesFarthestAlongItsDirection) {
  const CovarianceFunction function(
      Covariance::oriented(CovarianceShape::exponential, 20, 1, oracle::radians(30), 0));
  const auto at = [&](double degrees) {
    const double angle = oracle::radians(degrees);
    return function({0.5 * std::cos(angle), 0.5 * std::sin(angle)});
  };
  EXPECT_NEAR(at(30), std::exp(-0.5 / 20), 1e-14);
  EXPECT_NEAR(at(120), std::exp(-0.5), 1e-14);
  EXPECT_LT(at(60), at(40));
}

/// Greatest error of the covariances of points with the boxes of a grid.
double worst_error(const Covariance& covariance, const AverageGrid& grid) {
  const BoxCovariance boxes(covariance, grid);
  std::vector<double> values(grid.count());
  oracle::Random random(5);
  double worst = 0;
  for (int i = 0; i < 4; ++i) {
    // Also on corners of boxes and on their edges, where many samples lie.
    const auto place = [&] {
      const double any = random.uniform(grid.origin, grid.origin + 2.4 * grid.edge);
      return i % 2 == 0 ? any : grid.origin + grid.edge * static_cast<double>(random.below(3)) / 2;
    };
    const UnitPoint point{place(), place()};
    boxes.with_point(point, values);
    for (const std::size_t box : {std::size_t{0}, grid.count() - 1}) {
      const Real truth = oracle::covariance_with_box(covariance, point, grid, box);
      worst = std::max(worst, static_cast<double>(std::abs(values[box] - truth)));
    }
  }
  return worst;
}

TEST(BoxCovariance, OfPointsIsThatOfAnIntegral) {
  for (const Covariance& covariance : oracle::covariances()) {
    EXPECT_LT(worst_error(covariance, AverageGrid::of_node(8)), 2.1e-7) << oracle::name(covariance);
    EXPECT_LT(worst_error(covariance, AverageGrid::of_node(1)), 1.2e-6) << oracle::name(covariance);
  }
}

TEST(BoxCovariance, OfBoxesIsTheMeanOfThatOfPoints) {
  for (const Covariance& covariance : oracle::covariances()) {
    for (const std::size_t side : {std::size_t{8}, std::size_t{1}}) {
      const AverageGrid grid = AverageGrid::of_node(side);
      const BoxCovariance boxes(covariance, grid);
      for (const UnitPoint d : {UnitPoint{0, 0}, UnitPoint{grid.edge, -0.2}}) {
        EXPECT_NEAR(boxes.with_box(d),
                    static_cast<double>(oracle::covariance_of_boxes(covariance, d, grid.edge)),
                    side == 8 ? 5.7e-7 : 3e-6)
            << oracle::name(covariance) << ", side " << side;
      }
    }
  }
}

TEST(BoxCovariance, LengthsAndBoxesMayBeScaledTogether) {
  for (Covariance covariance : oracle::covariances()) {
    const AverageGrid fine{2, 0.1, 0.05}, coarse{2, 0.2, 0.1};
    std::vector<double> a(4), b(4);
    BoxCovariance(covariance, fine).with_point({0.13, 0.08}, a);
    covariance.along *= 2;
    covariance.across *= 2;
    covariance.frequency /= 2;
    BoxCovariance(covariance, coarse).with_point({0.26, 0.16}, b);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], 1e-12);
  }
}

std::string refusal(const Covariance& covariance) {
  try {
    CovarianceFunction function(covariance);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Covariance, RefusesWhatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Covariance good;
  const auto with = [&](auto member, auto value) {
    Covariance bad = good;
    bad.*member = value;
    return refusal(bad);
  };
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_EQ(with(&Covariance::along, 0.0), "freqsynth: along is 0, not in 0.01..1000");
  EXPECT_EQ(with(&Covariance::across, nan), "freqsynth: across is nan, not in 0.01..1000");
  EXPECT_EQ(with(&Covariance::angle, 1e9), "freqsynth: angle is 1e+09, not in -100..100");
  EXPECT_EQ(with(&Covariance::noise, -1.0), "freqsynth: noise is -1, not in 0..1e6");
  EXPECT_EQ(with(&Covariance::frequency, 1.0),
            "freqsynth: frequency is 1, not 0, which it is for shapes that are not smooth");
  EXPECT_EQ(with(&Covariance::shape, static_cast<CovarianceShape>(9)),
            "freqsynth: shape is 9, not a CovarianceShape");
}

TEST(BoxCovariance, RefusesAGridThatIsNone) {
  EXPECT_THROW(BoxCovariance({}, {0, 0, 0.1}), std::invalid_argument);
  EXPECT_THROW(BoxCovariance({}, {33, 0, 0.1}), std::invalid_argument);
  EXPECT_THROW(BoxCovariance({}, {8, -5, 0.1}), std::invalid_argument);
  EXPECT_THROW(BoxCovariance({}, {8, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
