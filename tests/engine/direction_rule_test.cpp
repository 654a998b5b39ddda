// SPDX-License-Identifier: MIT
#include "freqsynth/engine/direction_rule.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "freqsynth/engine/tree_sampler.h"
#include "support/gaussian_process_oracle.h"

namespace freqsynth {
namespace {

/// A sampler of one block that has had 81 samples of a function.
template <class F>
void sample(TreeSampler& sampler, F&& function) {
  sampler.run(function, 81);
  ASSERT_EQ(sampler.tree().node(0).samples, 81u);
}

TreeSettings one_block(std::vector<float> weights) {
  TreeSettings settings;
  settings.width = settings.height = 8;
  settings.weights = std::move(weights);
  settings.depth = 0;  // so that it stays whole
  settings.seed = 2;
  return settings;
}

/// Narrow stripes all over the block.
float stripes(double x, double y) { return std::sin(1.9 * x + 0.7 * y) > 0 ? 1.0f : 0.0f; }

TEST(DirectionRule, FindsTheEvidenceOfDenseKriging) {
  TreeSampler sampler(one_block({3, 1}));
  ASSERT_NO_FATAL_FAILURE(sample(sampler, [](double x, double y) {
    return std::array{stripes(x, y), static_cast<float>(std::sin(x) + 0.1 * y)};
  }));
  const NodeTree& tree = sampler.tree();
  std::vector<UnitPoint> points;
  for (std::size_t i = 0; i < 81; ++i) {
    points.push_back({tree.positions().s(0, i), tree.positions().t(0, i)});
  }
  DirectionRule rule;
  ASSERT_EQ(rule.priors().size(), 36u);
  std::vector<double> differences;
  for (const std::size_t prior : {0u, 1u, 2u, 4u, 5u, 20u}) {
    oracle::Real squares = 0, logarithm = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const std::span<const float> values = tree.values(0, c);
      const oracle::GaussianProcess process(rule.priors()[prior], points,
                                            std::vector<double>(values.begin(), values.end()),
                                            AverageGrid::of_node(1));
      squares += (c == 0 ? 0.75L : 0.25L) * process.quadratic;
      logarithm = process.log_determinant;
    }
    const double wanted = static_cast<double>(-0.5L * (80 * std::log(squares / 80) + logarithm));
    EXPECT_NEAR(rule.evidence(tree, 0, prior), wanted, 2e-3) << prior;
  }
}

TEST(DirectionRule, KeepsStripesWhole) {
  TreeSampler sampler(one_block({1}));
  ASSERT_NO_FATAL_FAILURE(sample(sampler, stripes));
  EXPECT_LT(DirectionRule::gain_of_split(sampler.tree(), 0), 4.0 / 3);
  DirectionRule rule;
  EXPECT_TRUE(rule.goes_on(sampler.tree(), 0));
}

TEST(DirectionRule, KeepsSmoothBlocksWhole) {
  TreeSampler sampler(one_block({1}));
  ASSERT_NO_FATAL_FAILURE(sample(sampler, [](double x, double y) {
    return static_cast<float>(std::sin(0.5 * x) + std::cos(0.4 * y + 0.2 * x));
  }));
  DirectionRule rule;
  EXPECT_TRUE(rule.goes_on(sampler.tree(), 0));
}

TEST(DirectionRule, SplitsWhereQuadrantsHaveNothingToDo) {
  TreeSampler sampler(one_block({1}));
  // An edge that has one direction, through two quadrants.
  ASSERT_NO_FATAL_FAILURE(
      sample(sampler, [](double x, double y) { return x + 0.1 * y > 2.3 ? 1.0f : 0.0f; }));
  EXPECT_GT(DirectionRule::gain_of_split(sampler.tree(), 0), 4.0 / 3);
  DirectionRule rule, of_direction_alone(5);
  EXPECT_FALSE(rule.goes_on(sampler.tree(), 0));
  EXPECT_TRUE(of_direction_alone.goes_on(sampler.tree(), 0));
}

TEST(DirectionRule, SplitsWhatHasNoDirection) {
  TreeSampler sampler(one_block({1}));
  // Edges of four directions.
  ASSERT_NO_FATAL_FAILURE(sample(sampler, [](double x, double y) {
    return static_cast<float>((x > 3.3) + (y > 4.6) + (x + y > 6.2) + (x - y > 0.9));
  }));
  DirectionRule rule(5);
  EXPECT_FALSE(rule.goes_on(sampler.tree(), 0));
}

TEST(DirectionRule, GainIsThatOfSamplesWhereTheyAreNeeded) {
  TreeSampler flat(one_block({1})), spot(one_block({1}));
  ASSERT_NO_FATAL_FAILURE(sample(flat, [](double, double) { return 7.0f; }));
  EXPECT_EQ(DirectionRule::gain_of_split(flat.tree(), 0), 4);
  DirectionRule rule;
  EXPECT_FALSE(rule.goes_on(flat.tree(), 0));
  ASSERT_NO_FATAL_FAILURE(sample(
      spot, [](double x, double y) { return x > 5 && y > 5 && x < 7 && y < 7 ? 1.0f : 0.0f; }));
  EXPECT_GT(DirectionRule::gain_of_split(spot.tree(), 0), 2.5);
  EXPECT_LE(DirectionRule::gain_of_split(spot.tree(), 0), 4);
}

}  // namespace
}  // namespace freqsynth
