// SPDX-License-Identifier: MIT
// Priors that oscillate, in a bank.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "freqsynth/refine/bank_estimator.h"
#include "support/gaussian_process_oracle.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Real;

constexpr float untried = -std::numeric_limits<float>::infinity();

/// As NodePositions moves them: waves are not told from each other on a plain lattice.
std::vector<UnitPoint> points(std::size_t count) {
  SampleSequence sequence;
  std::vector<UnitPoint> at = sequence_points(sequence, count);
  for (std::size_t i = 0; i < count; ++i) {
    at[i].s += 0.03 * std::sin(12.9 * static_cast<double>(i));
    at[i].t += 0.03 * std::cos(7.7 * static_cast<double>(i));
  }
  return at;
}

Covariance wave(double frequency, double angle) {
  return Covariance::oscillating(CovarianceShape::matern52, 1.2, frequency, angle, 0.001);
}

/// Two that are none, and six waves.
PriorBank bank_of_waves() {
  PriorBank bank;
  bank.add(Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003));
  bank.add(Covariance::isotropic(CovarianceShape::matern52, 1.5, 1e-4));
  const std::vector<Covariance> waves = {wave(1.5, 0.1), wave(3.4, 0.9), wave(2.5, 2.2),
                                         wave(3.2, 0.7), wave(3.3, 1.1), wave(5.5, 1.9)};
  bank.add_waves(waves);
  return bank;
}

/// Crests run in the direction `angle`.
std::vector<float> samples_of_wave(std::span<const UnitPoint> at, double frequency, double angle) {
  std::vector<float> values;
  for (const UnitPoint& p : at) {
    const double across = std::cos(angle) * p.t - std::sin(angle) * p.s;
    const double phase = 2 * static_cast<double>(oracle::pi) * frequency * across + 0.4;
    values.push_back(static_cast<float>(0.5 + 0.4 * std::cos(phase)));
  }
  return values;
}

struct Result {
  std::vector<float> averages, posterior, errors;
};

Result estimate(const BankLists& lists, std::span<const float> values,
                const BankSettings& settings = {}) {
  const std::size_t count = lists.grid().count();
  Result result{std::vector<float>(count), std::vector<float>(lists.size()),
                std::vector<float>(count)};
  BankNode nodes[] = {{values.data(), values.size(), nullptr, result.averages.data(),
                       result.posterior.data(), result.errors.data(), nullptr}};
  BankEstimator(lists, 1, settings).estimate(nodes);
  return result;
}

/// All members by dense algebra, from the first `count` samples.
struct Dense {
  std::vector<oracle::GaussianProcess> members;
  std::vector<Real> evidence;

  Dense(const PriorBank& bank, std::span<const UnitPoint> at, std::span<const float> values,
        std::size_t count, const AverageGrid& grid) {
    const std::vector<double> own(values.begin(),
                                  values.begin() + static_cast<std::ptrdiff_t>(count));
    for (const Covariance& member : bank.members()) {
      members.emplace_back(member, at.first(count), own, grid);
      evidence.push_back(-(static_cast<Real>(count - 1) * std::log(members.back().quadratic) +
                           members.back().log_determinant) /
                         2);
    }
  }
};

TEST(BankWaves, AreAveragedByTheirEvidenceWhereTheyExplainMore) {
  const PriorBank bank = bank_of_waves();
  const AverageGrid grid = AverageGrid::of_node(4);
  for (const std::size_t count : {std::size_t{25}, std::size_t{60}, std::size_t{190}}) {
    const auto at = points(count);
    const auto values = samples_of_wave(at, 3.3, 0.8);
    const Dense dense(bank, at, values, count, grid);
    // The first 176 samples tell which four are tried; and where these are all, only those count
    // that exceed the best of the others.
    const Dense probe(bank, at, values, std::min<std::size_t>(count, 176), grid);
    std::vector<std::size_t> order = {2, 3, 4, 5, 6, 7};
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return probe.evidence[a] > probe.evidence[b]; });
    std::vector<std::size_t> tried = {0, 1};
    for (std::size_t k = 0; k < 4; ++k) {
      const bool more = probe.evidence[order[k]] > std::max(dense.evidence[0], dense.evidence[1]);
      if (count > 176 || more) tried.push_back(order[k]);
    }
    ASSERT_GT(tried.size(), 2u);

    const BankLists lists(bank, at, grid);
    const Result found = estimate(lists, values);
    Real best = dense.evidence[0], total = 0;
    for (const std::size_t k : tried) best = std::max(best, dense.evidence[k]);
    std::vector<Real> weights(bank.members().size(), 0);
    for (const std::size_t k : tried)
      total += weights[k] = std::exp((dense.evidence[k] - best) / 2);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (weights[k] > 0) {
        EXPECT_NEAR(found.posterior[k], static_cast<double>(std::log(weights[k])), 0.02) << k;
      } else {
        EXPECT_EQ(found.posterior[k], untried) << k;
      }
    }
    for (std::size_t p = 0; p < grid.count(); ++p) {
      Real mean = 0;
      for (std::size_t k = 0; k < weights.size(); ++k) {
        mean += weights[k] / total * dense.members[k].means[p];
      }
      EXPECT_NEAR(found.averages[p], static_cast<double>(mean), 2e-4) << count << ", " << p;
    }
  }
}

TEST(BankWaves, AreTriedWhereOthersExplainBadly) {
  const auto at = points(60);
  const BankLists lists(bank_of_waves(), at, AverageGrid::of_node(4));
  // So long a wave is explained better than white noise by all.
  const auto values = samples_of_wave(at, 1.5, 0.1);
  const auto tried = [&](double badly) {
    const auto posterior = estimate(lists, values, {.badly = badly}).posterior;
    return posterior.size() -
           static_cast<std::size_t>(std::count(posterior.begin(), posterior.end(), untried));
  };
  EXPECT_GT(tried(3), 2u);
  EXPECT_EQ(tried(0), 2u);
  EXPECT_THROW(estimate(lists, values, {.badly = -1}), std::invalid_argument);
}

TEST(BankWaves, NeedAveragesThatTellThem) {
  const auto at = points(60);
  const auto values = samples_of_wave(at, 3.3, 0.8);
  const BankLists half(bank_of_waves(), at, AverageGrid::of_node(2));
  const auto posterior = estimate(half, values).posterior;
  EXPECT_EQ(std::count(posterior.begin(), posterior.end(), untried), 6);
  const BankLists few(bank_of_waves(), at, AverageGrid::of_node(4));
  const auto of_few = estimate(few, std::span(values).first(9)).posterior;
  EXPECT_EQ(std::count(of_few.begin(), of_few.end(), untried), 6);
}

TEST(BankWaves, TellWhatNoOtherPriorDoes) {
  // Waves shorter than twice the distance of samples along the axes.
  const auto at = points(81);
  const PriorBank exact = PriorBank::exact();
  PriorBank without;
  for (const PriorGroup& group : exact.groups()) {
    if (group.count == 1) without.add(exact.members()[group.first]);
  }
  PriorBank with = without;
  with.add_waves(wave_priors());
  const AverageGrid grid = AverageGrid::of_node(8);
  const double angle = 0.3, frequency = 5.1;
  const auto values = samples_of_wave(at, frequency, angle);
  const auto error = [&](const PriorBank& bank) {
    const BankLists lists(bank, at, grid);
    const Result found = estimate(lists, values);
    double sum = 0;
    for (std::size_t p = 0; p < 64; ++p) {
      double mean = 0;
      for (std::size_t k = 0; k < 256; ++k) {
        const UnitPoint point[] = {
            {(static_cast<double>(p % 8) + (static_cast<double>(k % 16) + 0.5) / 16) / 8,
             (static_cast<double>(p / 8) + (static_cast<double>(k / 16) + 0.5) / 16) / 8}};
        mean += double{samples_of_wave(point, frequency, angle)[0]} / 256;
      }
      sum += std::pow(double{found.averages[p]} - mean, 2);
    }
    return std::sqrt(sum / 64);
  };
  EXPECT_LT(error(with), 0.1 * error(without));
}

TEST(BankWaves, AreOnAPolarGrid) {
  const std::vector<Covariance> waves = wave_priors();
  EXPECT_GT(waves.size(), 100u);
  EXPECT_LT(waves.size(), 140u);
  // No wave of 1 to 6.25 is farther from one of them than a step.
  for (double frequency = 1; frequency <= 6.25; frequency += 0.05) {
    for (double angle = 0; angle < 3.14; angle += 0.05) {
      double nearest = 100;
      for (const Covariance& one : waves) {
        const double x = one.frequency * std::cos(one.angle),
                     y = one.frequency * std::sin(one.angle);
        const double u = frequency * std::cos(angle), v = frequency * std::sin(angle);
        nearest = std::min({nearest, std::hypot(u - x, v - y), std::hypot(u + x, v + y)});
      }
      EXPECT_LT(nearest, 0.6);
    }
  }
}

TEST(BankWaves, ListsAreMadeWhenTheyAreNeeded) {
  const auto at = points(81);
  const BankLists lists(PriorBank::exact(), at, AverageGrid::of_node(8));
  const std::size_t before = lists.memory(), wave = lists.size() - 1;
  lists.probe(wave).reserve(81);
  EXPECT_GT(lists.memory(), before);
  EXPECT_EQ(&lists.probe(wave), &lists.probe(wave));
  EXPECT_TRUE(lists.is_made(0));
  EXPECT_FALSE(lists.is_made(wave));
  // The same evidence.
  for (const std::size_t row : {1u, 40u, 80u}) {
    EXPECT_EQ(lists.probe(wave).row(row).log_determinant, lists[wave].row(row).log_determinant);
    const auto a = lists.probe(wave).row(row).factor, b = lists[wave].row(row).factor;
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
}

TEST(BankWaves, AreOneGroupAfterOthers) {
  PriorBank bank;
  EXPECT_THROW(bank.add_waves(wave_priors()), std::invalid_argument);
  bank.add(Covariance{});
  const std::vector<Covariance> bad = {wave(17, 0)};
  EXPECT_THROW(bank.add_waves(bad), std::invalid_argument);
  EXPECT_EQ(bank.members().size(), 1u);
  bank.add_waves(wave_priors());
  EXPECT_TRUE(bank.groups().back().waves);
  EXPECT_EQ(bank.groups().back().first, 1u);
  EXPECT_THROW(bank.add_waves(wave_priors()), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
