// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/engine/tree_sampler.h"
#include "support/oracles.h"
#include "support/tree_helpers.h"

namespace freqsynth {
namespace {

TreeSettings gray(double exploration) {
  TreeSettings settings = tree_helpers::settings_of(128, 64);
  settings.weights = {1};
  settings.exploration = exploration;
  return settings;
}

/// To the right of the middle rings that no number of samples is enough for; flat to the left, but
/// for what lies there.
float half(double x, double y) {
  return x < 64 ? 0.0f : static_cast<float>(0.5 + 0.5 * std::cos(0.05 * (x * x + y * y)));
}

/// The fewest samples that a leaf has had which may have more, for its area, in blocks.
double fewest(const TreeSampler& sampler) {
  double least = std::numeric_limits<double>::infinity();
  const NodeTree& tree = sampler.tree();
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const TreeNode& node = tree.node(leaf);
    if (!node.leaf() || node.complete()) continue;
    least = std::min(least, 64.0 * node.samples / tree.area(leaf));
  }
  return least;
}

TEST(TreeExploration, NoLeafStaysBehind) {
  for (const double exploration : {0.5, 0.82, 1.0}) {
    DirectionRule rule;
    TreeSampler sampler(gray(exploration), &rule);
    for (const std::uint64_t mean : {16u, 64u, 128u}) {
      sampler.run(half, 128 * mean);
      // The last wave may still be at it: what was to be there when one began is.
      const double before = static_cast<double>(mean) * (1 - 1.0 / 16);
      EXPECT_GE(fewest(sampler) + 1, std::pow(before, exploration)) << exploration << " " << mean;
    }
  }
  DirectionRule rule;
  TreeSampler sampler(gray(0), &rule);
  sampler.run(half, 128 * 128);
  EXPECT_LT(fewest(sampler), 10);
}

TEST(TreeExploration, BlocksThatAreNotToBeSampledAreLeftOut) {
  TreeSampler sampler(gray(1));
  std::vector<float> factors(128, 1);
  for (std::size_t block = 0; block < 128; block += 3) factors[block] = 0;
  sampler.use_factors(factors);
  sampler.run(half, 3000);
  for (std::uint32_t block = 0; block < 128; ++block) {
    const std::uint32_t samples = sampler.tree().node(block).samples;
    // Of others more than one sample may be known, from the blocks around.
    if (factors[block] > 0) {
      EXPECT_GE(samples, 25u) << block;
    }
  }
}

/// Jittered samples find them as well, one in each pixel.
TEST(TreeExploration, DiscsOfRadiusTwoAreFoundBesideAnythingBusy) {
  oracle::Random random(5);
  int lost = 0;
  // Lists of positions are there as long as somebody has them.
  const TreeSampler keeper(gray(0.82));
  for (int place = 0; place < 40; ++place) {
    const double x = random.uniform(8, 56), y = random.uniform(8, 56);
    const auto found_by = [&](double exploration) {
      DirectionRule rule;
      TreeSampler sampler(gray(exploration), &rule);
      bool found = false;
      sampler.run(
          [&](double at_x, double at_y) {
            if (std::hypot(at_x - x, at_y - y) >= 2) return half(at_x, at_y);
            found = true;
            return 1.0f;
          },
          128 * 64);
      return found;
    };
    EXPECT_TRUE(found_by(0.82)) << x << " " << y;
    lost += found_by(0) ? 0 : 1;
  }
  EXPECT_GT(lost, 10) << "without";
}

}  // namespace
}  // namespace freqsynth
