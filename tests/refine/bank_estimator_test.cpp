// SPDX-License-Identifier: MIT
#include "freqsynth/refine/bank_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/gaussian_process_oracle.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Real;

std::vector<UnitPoint> points(std::size_t count) {
  SampleSequence sequence;
  return sequence_points(sequence, count);
}

PriorBank small_bank() {
  PriorBank bank;
  bank.add(Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003));
  bank.add(Covariance::isotropic(CovarianceShape::matern52, 1.5, 1e-4));
  bank.add(Covariance::oriented(CovarianceShape::exponential, 20, 1, 0.6, 0.003));
  return bank;
}

/// Samples of a soft slanted edge in three channels.
std::vector<float> edge_samples(std::span<const UnitPoint> at, double angle = 0.5) {
  std::vector<float> values;
  for (const UnitPoint& p : at) {
    const double across = std::cos(angle) * (p.t - 0.45) - std::sin(angle) * (p.s - 0.5);
    const double value = 0.5 + 0.4 * std::tanh(12 * across);
    for (const double scale : {1.0, 0.5, -0.25}) {
      values.push_back(static_cast<float>(scale * value + 0.1 * p.s));
    }
  }
  return values;
}

struct Result {
  std::vector<float> averages, posterior, errors, doubts;
};

Result estimate(const BankLists& lists, std::span<const float> values, std::size_t channels,
                const float* parent = nullptr, const BankSettings& settings = {}) {
  const std::size_t count = lists.grid().count();
  Result result{std::vector<float>(channels * count), std::vector<float>(lists.size()),
                std::vector<float>(count), std::vector<float>(count)};
  BankNode nodes[] = {{values.data(), values.size() / channels, parent, result.averages.data(),
                       result.posterior.data(), result.errors.data(), result.doubts.data()}};
  BankEstimator(lists, channels, settings).estimate(nodes);
  return result;
}

TEST(BankEstimator, AveragesGaussianProcessesByTheirEvidence) {
  const PriorBank bank = small_bank();
  for (const AverageGrid& grid : {AverageGrid::of_node(4), AverageGrid::with_margin(4, 1)}) {
    const auto at = points(41);
    const BankLists lists(bank, at, grid);
    const auto values = edge_samples(at);
    for (const std::size_t samples : {1u, 2u, 9u, 41u}) {
      std::vector<Real> evidence, scales;
      std::vector<std::vector<oracle::GaussianProcess>> processes;
      for (const Covariance& member : bank.members()) {
        processes.emplace_back();
        Real sum = 0, earlier = 0;
        const std::size_t half = (samples + 1) / 2;
        for (std::size_t c = 0; c < 3; ++c) {
          std::vector<double> own;
          for (std::size_t i = 0; i < samples; ++i) own.push_back(values[3 * i + c]);
          processes.back().emplace_back(member, std::span(at).first(samples), own, grid);
          sum += processes.back().back().quadratic;
          own.resize(half);
          earlier +=
              oracle::GaussianProcess(member, std::span(at).first(half), own, grid).quadratic;
        }
        const auto differences = static_cast<Real>(samples - 1);
        // The mean square of the later innovations, and one more that is as all are in the mean.
        scales.push_back((sum - earlier + (samples > 1 ? sum / differences : 0)) /
                         static_cast<Real>(samples - half + 1));
        const Real log_evidence =
            samples == 1 ? 0
                         : -(differences * std::log(sum) + processes.back()[0].log_determinant) / 2;
        evidence.push_back(log_evidence / 2);  // tempered
      }
      const Real best = *std::max_element(evidence.begin(), evidence.end());
      Real total = 0;
      for (Real& one : evidence) total += one = std::exp(one - best);

      const Result found = estimate(lists, std::span(values).first(3 * samples), 3);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(found.posterior[k], static_cast<double>(std::log(evidence[k])), 2e-3);
      }
      for (std::size_t p = 0; p < grid.count(); ++p) {
        Real error = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          Real mean = 0, square = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const Real value = processes[k][c].means[p];
            mean += evidence[k] / total * value;
            square += evidence[k] / total * value * value;
          }
          EXPECT_NEAR(found.averages[c * grid.count() + p], static_cast<double>(mean), 1e-4)
              << samples << " samples, average " << p;
          error += square - mean * mean;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          error += evidence[k] / total * scales[k] * processes[k][0].variances[p];
        }
        EXPECT_NEAR(found.errors[p], static_cast<double>(error / 3), 1e-4) << samples;
      }
    }
  }
}

TEST(BankEstimator, ThreeEqualChannelsSayNoMoreThanOne) {
  const auto at = points(25);
  const BankLists lists(small_bank(), at, AverageGrid::of_node(8));
  std::vector<float> one, three;
  const auto values = edge_samples(at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    one.push_back(values[3 * i]);
    three.insert(three.end(), 3, values[3 * i]);
  }
  const Result a = estimate(lists, one, 1), b = estimate(lists, three, 3);
  for (std::size_t p = 0; p < 3 * 64; ++p) EXPECT_NEAR(b.averages[p], a.averages[p % 64], 1e-6);
  for (std::size_t p = 0; p < 64; ++p)
    EXPECT_NEAR(b.errors[p], a.errors[p], 1e-6 + a.errors[p] / 1e4);
}

TEST(BankEstimator, KnowsTheScaleOfNothing) {
  // Values in units of any power of two, and around any level that leaves them their digits.
  const auto at = points(25);
  const BankLists lists(PriorBank::exact(), at, AverageGrid::of_node(8));
  const auto values = edge_samples(at);
  const Result plain = estimate(lists, values, 3);
  auto scaled = values;
  for (float& value : scaled) value *= 1024;
  const Result large = estimate(lists, scaled, 3);
  for (std::size_t p = 0; p < 3 * 64; ++p) {
    EXPECT_NEAR(large.averages[p], 1024 * plain.averages[p], 1e-2);
  }
  for (std::size_t p = 0; p < 64; ++p) {
    EXPECT_NEAR(large.errors[p], 1048576 * plain.errors[p], 1 + plain.errors[p] * 1e4);
  }
}

TEST(BankEstimator, GivesTheSameForANodeWhateverIsEstimatedBesides) {
  const auto at = points(41);
  const BankLists lists(PriorBank::exact(), at, AverageGrid::of_node(8));
  BankEstimator together(lists, 3);
  constexpr std::size_t count = 600;
  std::vector<std::vector<float>> values, averages(count, std::vector<float>(192));
  std::vector<BankNode> nodes(count);
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(
        edge_samples(std::span(at).first(1 + i * 7 % 41), 0.01 * static_cast<double>(i)));
    nodes[i].values = values[i].data();
    nodes[i].count = 1 + i * 7 % 41;
    nodes[i].averages = averages[i].data();
  }
  together.estimate(nodes);
  for (std::size_t i = 0; i < count; i += 37) {
    EXPECT_EQ(estimate(lists, values[i], 3).averages, averages[i]) << i;
  }
}

TEST(BankEstimator, ReproducesALevelExactlyAndASlopeNearly) {
  const auto at = points(25);
  const BankLists lists(PriorBank::exact(), at, AverageGrid::of_node(8));
  const Result level = estimate(lists, std::vector<float>(25, 0.3f), 1);
  for (const float average : level.averages) EXPECT_EQ(average, 0.3f);
  for (const float error : level.errors) EXPECT_LT(error, 1e-12);
  std::vector<float> slope;
  for (const UnitPoint& p : at) slope.push_back(static_cast<float>(2 * p.s - p.t));
  const Result result = estimate(lists, slope, 1);
  for (std::size_t p = 0; p < 64; ++p) {
    const double s = (static_cast<double>(p % 8) + 0.5) / 8;
    const double t = (static_cast<double>(p / 8) + 0.5) / 8;
    EXPECT_NEAR(result.averages[p], 2 * s - t, 6e-4);
  }
}

TEST(BankEstimator, FindsTheDirectionOfAnEdge) {
  PriorBank bank;
  bank.add_directions(Covariance::oriented(CovarianceShape::exponential, 20, 1, 0, 0.003), 16);
  const auto at = points(81);
  const BankLists lists(bank, at, AverageGrid::of_node(8));
  for (int direction = 0; direction < 16; ++direction) {
    const double angle = static_cast<double>(oracle::pi) * direction / 16;
    std::vector<float> values;
    for (const UnitPoint& p : at) {
      const double across = std::cos(angle) * (p.t - 0.47) - std::sin(angle) * (p.s - 0.52);
      values.push_back(across > 0 ? 1.0f : 0.0f);
    }
    const Result result = estimate(lists, values, 1);
    const auto best = std::max_element(result.posterior.begin(), result.posterior.end());
    EXPECT_EQ(best - result.posterior.begin(), direction);
    // Not all were tried.
    EXPECT_EQ(std::count(result.posterior.begin(), result.posterior.end(),
                         -std::numeric_limits<float>::infinity()),
              8);
  }
}

TEST(BankEstimator, BeginsWithWhatTheParentFound) {
  const auto at = points(9);
  const BankLists lists(small_bank(), at, AverageGrid::of_node(8));
  const auto values = edge_samples(at);
  const Result alone = estimate(lists, values, 3);
  const float parent[] = {-8, 0, -3};
  const Result child = estimate(lists, values, 3, parent);
  float expected[3];
  for (std::size_t k = 0; k < 3; ++k) expected[k] = alone.posterior[k] + 0.5f * parent[k];
  const float best = *std::max_element(expected, expected + 3);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(child.posterior[k], expected[k] - best, 1e-5);
}

TEST(BankEstimator, DoubtsWhatLiesOutsideMore) {
  const auto at = points(25);
  const BankLists lists(PriorBank::exact(), at, AverageGrid::with_margin(8, 2));
  const Result result = estimate(lists, edge_samples(at), 3);
  double inside = 0, outside = 0;
  for (std::size_t p = 0; p < 144; ++p) {
    const bool within = p % 12 >= 2 && p % 12 < 10 && p / 12 >= 2 && p / 12 < 10;
    if (within) {
      inside += double{result.doubts[p]} / 64;
    } else {
      outside += double{result.doubts[p]} / 80;
    }
  }
  EXPECT_NEAR(inside, 1, 1e-5);
  EXPECT_GT(outside, 1.5);
  EXPECT_GT(result.doubts[0], 2);
}

TEST(BankEstimator, RefusesWhatIsNone) {
  const auto at = points(9);
  const BankLists lists(small_bank(), at, AverageGrid::of_node(8));
  EXPECT_THROW(BankEstimator(lists, 0), std::invalid_argument);
  EXPECT_THROW(BankEstimator(lists, 1, {.temper = 0.5}), std::invalid_argument);
  EXPECT_THROW(BankEstimator(lists, 1, {.inherit = -1}), std::invalid_argument);
  BankNode nodes[2];
  BankEstimator estimator(lists, 1);
  EXPECT_THROW(estimator.estimate(nodes), std::invalid_argument);
  nodes[0].count = 10;
  EXPECT_THROW(estimator.estimate(std::span(nodes).first(1)), std::invalid_argument);
  EXPECT_THROW(BankLists(PriorBank(), at, AverageGrid::of_node(8)), std::invalid_argument);
  PriorBank bank;
  EXPECT_THROW(bank.add_directions(Covariance{}, 5), std::invalid_argument);
  EXPECT_THROW(bank.add({.along = -1}), std::invalid_argument);
  EXPECT_TRUE(bank.members().empty());
}

TEST(PriorBank, IsOfAFewDozenMembersWhoseListsAreSmall) {
  EXPECT_EQ(PriorBank::exact().members().size(), 38 + wave_priors().size());
  EXPECT_EQ(PriorBank::noisy().members().size(), 68u);
  const BankLists lists(PriorBank::exact(), points(81), AverageGrid::of_node(8));
  for (std::size_t k = 0; k < 38; ++k) lists[k].reserve(81);
  EXPECT_LT(lists.memory(), 38u * 81 * (2 * 85 + 4 * 64 + 72));
}

}  // namespace
}  // namespace freqsynth
