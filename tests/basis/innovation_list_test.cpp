// SPDX-License-Identifier: MIT
#include "freqsynth/basis/innovation_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/covariance_oracle.h"
#include "support/gaussian_process_oracle.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Real;

std::vector<UnitPoint> points(std::size_t count) {
  SampleSequence sequence;
  return sequence_points(sequence, count);
}

/// Innovations as the header says they are computed.
std::vector<double> innovations(const InnovationList& list, std::span<const double> values) {
  std::vector<double> z;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const InnovationRow& row = list.row(i);
    double rest = values[i];
    for (std::size_t j = 0; j < i; ++j) rest -= double{row.factor[j]} * z[j];
    z.push_back(rest * double{row.inverse_pivot});
  }
  return z;
}

std::vector<double> averages(const InnovationList& list, std::span<const double> z) {
  std::vector<double> sums(list.grid().count());
  for (std::size_t i = 0; i < z.size(); ++i) {
    for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += double{list.row(i).gains[p]} * z[i];
  }
  return sums;
}

double quadratic(std::span<const double> z) {
  return std::inner_product(z.begin() + 1, z.end(), z.begin() + 1, 0.0);
}

std::vector<double> random_values(std::size_t count, unsigned seed) {
  oracle::Random random(seed);
  std::vector<double> values(count);
  for (double& value : values) value = random.uniform(-1, 1);
  return values;
}

/// Smooth values, which a smooth prior does not find absurd.
std::vector<double> smooth_values(std::span<const UnitPoint> at) {
  std::vector<double> values;
  for (const UnitPoint& p : at) values.push_back(std::sin(2 * p.s + 0.5) * std::cos(p.t) + p.t);
  return values;
}

TEST(InnovationList, GivesTheEstimateAndEvidenceOfAGaussianProcess) {
  for (const Covariance& covariance : oracle::covariances()) {
    for (const AverageGrid& grid : {AverageGrid::of_node(2), AverageGrid::with_margin(4, 1)}) {
      const auto at = points(50);
      const InnovationList list(covariance, at, grid);
      const auto values = smooth_values(at);
      for (const std::size_t count : {1u, 2u, 5u, 13u, 25u, 50u}) {
        const auto z = innovations(list, std::span(values).first(count));
        const oracle::GaussianProcess truth(covariance, std::span(at).first(count),
                                            std::span(values).first(count), grid);
        const auto found = averages(list, z);
        for (std::size_t p = 0; p < grid.count(); ++p) {
          EXPECT_NEAR(found[p], static_cast<double>(truth.means[p]), 2e-5)
              << oracle::name(covariance) << ", samples " << count << ", average " << p;
        }
        EXPECT_NEAR(list.row(count - 1).log_determinant, static_cast<double>(truth.log_determinant),
                    1e-7 * static_cast<double>(count))
            << oracle::name(covariance);
        EXPECT_NEAR(quadratic(z), static_cast<double>(truth.quadratic),
                    2e-4 * static_cast<double>(truth.quadratic) + 1e-6)
            << oracle::name(covariance) << ", samples " << count;
        EXPECT_NEAR(list.row(count - 1).variance, static_cast<double>(truth.variance), 1e-6)
            << oracle::name(covariance) << ", samples " << count;
      }
    }
  }
}

TEST(InnovationList, MakesNothingOfTheOrderOfSamples) {
  const Covariance covariance = oracle::covariances()[1];
  auto at = points(41);
  const auto values = random_values(41, 3);
  std::vector<std::size_t> order(41);
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), oracle::Random(4).engine());
  std::vector<UnitPoint> other_points;
  std::vector<double> other_values;
  for (const std::size_t i : order) {
    other_points.push_back(at[i]);
    other_values.push_back(values[i]);
  }
  const InnovationList list(covariance, at), other(covariance, other_points);
  const auto z = innovations(list, values), other_z = innovations(other, other_values);
  const auto a = averages(list, z), b = averages(other, other_z);
  for (std::size_t p = 0; p < 64; ++p) EXPECT_NEAR(a[p], b[p], 2e-5);
  EXPECT_NEAR(quadratic(z), quadratic(other_z), 1e-4 * quadratic(z));
  EXPECT_NEAR(list.row(40).log_determinant, other.row(40).log_determinant, 1e-9);
  EXPECT_NEAR(list.row(40).variance, other.row(40).variance, 1e-7);
}

TEST(InnovationList, FindsALevelAndWhatStaysLevel) {
  for (const Covariance& covariance : oracle::covariances()) {
    const auto at = points(30);
    const InnovationList list(covariance, at);
    const std::vector<double> level(30, 1000.25);
    const auto z = innovations(list, level);
    EXPECT_EQ(z[0], 1000.25);
    for (std::size_t i = 1; i < z.size(); ++i) EXPECT_EQ(z[i], 0);
    for (const double average : averages(list, z)) EXPECT_EQ(average, 1000.25);
  }
}

TEST(InnovationList, WithoutNoiseASmallBoxAroundASampleIsTheSample) {
  for (const CovarianceShape shape :
       {CovarianceShape::exponential, CovarianceShape::matern32, CovarianceShape::matern52}) {
    const auto at = points(25);
    const auto values = random_values(25, 8);
    for (const std::size_t known : {std::size_t{0}, std::size_t{4}, std::size_t{17}}) {
      // A thousandth of the node, in whose middle the sample lies.
      const InnovationList list(Covariance::isotropic(shape, 1, 0),
                                [&] {
                                  auto moved = at;
                                  for (UnitPoint& p : moved) {
                                    p.s -= at[known].s - 0.0005;
                                    p.t -= at[known].t - 0.0005;
                                  }
                                  return moved;
                                }(),
                                {1, 0, 0.001});
      EXPECT_NEAR(averages(list, innovations(list, values))[0], values[known], 2e-3);
      EXPECT_LT(list.row(24).variance, 1e-3);
    }
  }
}

TEST(InnovationList, ExpectedErrorsFallAndAreThoseThatHappen) {
  const Covariance covariance = Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.01);
  const auto at = points(81);
  const InnovationList list(covariance, at);
  for (std::size_t i = 1; i < 81; ++i) EXPECT_LE(list.row(i).variance, list.row(i - 1).variance);
  // A process drawn on many points, whose means over pixels are known.
  const oracle::ProcessDraws draws(covariance, at, 8, 3);
  for (const std::size_t count : {5u, 25u, 81u}) {
    double squares = 0;
    constexpr int tries = 150;
    for (unsigned seed = 0; seed < tries; ++seed) {
      const auto draw = draws.draw(seed);
      const auto found = averages(list, innovations(list, std::span(draw.samples).first(count)));
      for (std::size_t p = 0; p < 64; ++p) squares += std::pow(found[p] - draw.averages[p], 2);
    }
    const double happened = squares / (64 * tries);
    EXPECT_NEAR(happened / list.row(count - 1).variance, 1, 0.15) << count;
  }
}

TEST(InnovationList, APointThatIsThereTwiceTellsOnlyOfItsNoise) {
  const std::vector<UnitPoint> at = {{0, 0}, {1, 1}, {0.5, 0.5}, {1, 1}};
  const std::vector<double> values = {0.1, 0.7, -0.2, 0.7};
  const InnovationList exact(Covariance::isotropic(CovarianceShape::exponential, 1, 0), at);
  EXPECT_EQ(exact.row(3).inverse_pivot, 0);
  EXPECT_EQ(exact.row(3).variance, exact.row(2).variance);
  EXPECT_EQ(exact.row(3).log_determinant, exact.row(2).log_determinant);
  const auto z = innovations(exact, values);
  EXPECT_EQ(averages(exact, z), averages(exact, std::span(z).first(3)));
  const InnovationList noisy(Covariance::isotropic(CovarianceShape::exponential, 1, 0.5), at);
  EXPECT_GT(noisy.row(3).inverse_pivot, 0);
  EXPECT_LT(noisy.row(3).variance, noisy.row(2).variance);
}

TEST(InnovationList, ALongOneStaysExact) {
  // Rows in float, and innovations in float, of all samples that a node has: against those in
  // double of the same rows.
  const Covariance smooth = Covariance::isotropic(CovarianceShape::matern52, 6, 1e-8);
  const auto at = points(289);
  const InnovationList list(smooth, at);
  const auto values = smooth_values(at);
  std::vector<float> z;
  std::vector<double> sums(64), truth = averages(list, innovations(list, values));
  for (std::size_t i = 0; i < 289; ++i) {
    const InnovationRow& row = list.row(i);
    float rest = static_cast<float>(values[i]);
    for (std::size_t j = 0; j < i; ++j) rest -= row.factor[j] * z[j];
    z.push_back(rest * row.inverse_pivot);
    for (std::size_t p = 0; p < 64; ++p) sums[p] += double{row.gains[p]} * double{z[i]};
  }
  for (std::size_t p = 0; p < 64; ++p) EXPECT_NEAR(sums[p], truth[p], 1e-6);
  for (std::size_t p = 0; p < 64; ++p) {
    const double s = (static_cast<double>(p % 8) + 0.5) / 8;
    const double t = (static_cast<double>(p / 8) + 0.5) / 8;
    // The mean over a pixel of a sine is that in its middle times a sinc.
    const double mean =
        std::sin(2 * s + 0.5) * std::cos(t) * std::sin(0.125) / 0.125 * std::sin(0.0625) / 0.0625 +
        t;
    EXPECT_NEAR(truth[p], mean, 1e-4) << p;
  }
}

std::string refusal(const std::vector<UnitPoint>& at, std::size_t index) {
  try {
    const InnovationList list({}, at);
    (void)list.row(index);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(InnovationList, RefusesWhatIsNone) {
  EXPECT_EQ(refusal({{0, 0}, {1, 1}}, 1), "accepted");
  EXPECT_EQ(refusal({{0, 0}, {1, 1}}, 2), "freqsynth: an innovation list of 3 rows exceeds 2");
  EXPECT_EQ(refusal({}, 0), "freqsynth: positions.size() is 0, not in 1..2048");
  EXPECT_EQ(refusal(std::vector<UnitPoint>(2049), 0),
            "freqsynth: positions.size() is 2049, not in 1..2048");
  EXPECT_EQ(refusal({{0, -6}}, 0), "freqsynth: position is -6, not in -4..5");
  EXPECT_EQ(refusal({{NAN, 0}}, 0), "freqsynth: position is nan, not in -4..5");
  EXPECT_EQ(refusal({{0, 0}}, static_cast<std::size_t>(-1)),
            "freqsynth: an innovation list of 0 rows exceeds 1");
}

bool same_row(const InnovationRow& a, const InnovationRow& b) {
  return std::equal(a.factor.begin(), a.factor.end(), b.factor.begin(), b.factor.end()) &&
         std::equal(a.gains.begin(), a.gains.end(), b.gains.begin(), b.gains.end()) &&
         a.inverse_pivot == b.inverse_pivot && a.variance == b.variance &&
         a.log_determinant == b.log_determinant;
}

TEST(InnovationListGrowth, GrowsAlikeInOneStepAndInManyAndMovesNothing) {
  const auto at = points(120);
  const InnovationList at_once(Covariance{}, at), stepwise(Covariance{}, at);
  at_once.reserve(120);
  EXPECT_EQ(at_once.size(), 120u);
  const float* third = stepwise.row(3).factor.data();
  for (std::size_t i = 0; i < 120; ++i) ASSERT_TRUE(same_row(stepwise.row(i), at_once.row(i))) << i;
  EXPECT_EQ(stepwise.row(3).factor.data(), third);
  EXPECT_EQ(stepwise.memory(), at_once.memory());
  EXPECT_LT(at_once.memory(), 120u * (2 * 120 + 4 * 64 + 128));
}

TEST(InnovationListGrowth, GrowsAlikeFromSeveralThreads) {
  const auto at = points(200);
  const InnovationList reference(Covariance{}, at), shared(Covariance{}, at);
  reference.reserve(200);
  std::vector<std::size_t> wrong(4);
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
    threads.emplace_back([&, thread] {
      for (std::size_t index = thread; index < 200; index += 1 + (index * 7 + thread) % 5) {
        wrong[thread] += same_row(shared.row(index), reference.row(index)) ? 0 : 1;
        wrong[thread] += same_row(shared.row(index / 2), reference.row(index / 2)) ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::accumulate(wrong.begin(), wrong.end(), std::size_t{0}), 0u);
}

}  // namespace
}  // namespace freqsynth
