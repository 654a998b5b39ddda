// SPDX-License-Identifier: MIT
#include "freqsynth/engine/tree_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/oracles.h"
#include "support/tree_helpers.h"

namespace freqsynth {
namespace {

using tree_helpers::Rgb;
using tree_helpers::scene;
using tree_helpers::settings_of;
using tree_helpers::shape;

using Places = std::map<std::pair<double, double>, Rgb>;

/// Runs and notes each call.
Places run(TreeSampler& sampler, std::uint64_t samples) {
  Places calls;
  const double width = static_cast<double>(sampler.settings().width);
  const double height = static_cast<double>(sampler.settings().height);
  sampler.run(
      [&](double x, double y) {
        EXPECT_TRUE(x >= 0 && x <= width && y >= 0 && y <= height) << x << " " << y;
        const Rgb rgb = scene(x, y);
        EXPECT_TRUE(calls.insert({{x, y}, rgb}).second) << "again " << x << " " << y;
        return rgb;
      },
      samples);
  return calls;
}

/// All that leaves know has been asked for, at the places of their own sequences; returns the
/// places.
std::set<std::pair<double, double>> known_places(const TreeSampler& sampler, const Places& calls) {
  std::set<std::pair<double, double>> known;
  const NodeTree& tree = sampler.tree();
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    if (!tree.node(leaf).leaf()) continue;
    for (std::size_t i = 0; i < tree.node(leaf).samples; ++i) {
      const BlockGrid::Point point = tree.point(tree.place(leaf, i));
      const auto call = calls.find({point.x, point.y});
      EXPECT_NE(call, calls.end()) << leaf << " " << i;
      if (call == calls.end()) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(tree.values(leaf, c)[i], call->second[c]);
      }
      known.insert({point.x, point.y});
    }
  }
  return known;
}

class TreeSamplerOf : public testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};
INSTANTIATE_TEST_SUITE_P(Sizes, TreeSamplerOf,
                         testing::Values(std::pair{64, 32}, std::pair{61, 35}, std::pair{8, 8},
                                         std::pair{1, 40}, std::pair{5, 4}));

TEST_P(TreeSamplerOf, AsksNoPlaceTwiceAndLeavesKnowWhatWasAsked) {
  for (const double perturbation : {0.0, 0.3}) {
    const auto [width, height] = GetParam();
    TreeSettings settings = settings_of(width, height);
    settings.perturbation = perturbation;
    TreeSampler sampler(settings);
    const std::uint64_t samples = 12 * width * height;
    const Places calls = run(sampler, samples);
    EXPECT_EQ(calls.size(), samples);
    EXPECT_EQ(sampler.stats().samples, samples);
    EXPECT_GT(sampler.stats().splits, 0u);
    const auto known = known_places(sampler, calls);
    // Of a lattice none is lost; of moved ones, some in blocks that have deep nodes.
    if (perturbation == 0) {
      EXPECT_EQ(known.size(), calls.size());
    } else {
      EXPECT_GE(static_cast<double>(known.size()), 0.95 * static_cast<double>(calls.size()));
    }
  }
}

TEST(TreeSampler, LosesNothingThatWasMovedAboveTheDeepNodes) {
  TreeSettings settings = settings_of(64, 32);
  settings.depth = 2;
  TreeSampler sampler(settings);
  const Places calls = run(sampler, 20000);
  EXPECT_EQ(known_places(sampler, calls).size(), calls.size());
}

TEST(TreeSampler, KnowsAllSamplesOfALeafThatOthersHaveTaken) {
  TreeSampler sampler(settings_of(64, 32));
  const Places calls = run(sampler, 6000);
  const NodeTree& tree = sampler.tree();
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    if (!tree.node(leaf).leaf() || tree.node(leaf).complete()) continue;
    const BlockGrid::Point next = tree.point(tree.place(leaf, tree.node(leaf).samples));
    EXPECT_FALSE(calls.contains({next.x, next.y})) << leaf;
  }
}

TEST(TreeSampler, GivesBackTheMemoryOfNodesThatAreSplit) {
  TreeSampler sampler(settings_of(64, 32));
  run(sampler, 12000);
  const NodeTree& tree = sampler.tree();
  std::size_t floats = 0;
  for (std::uint32_t number = 0; number < tree.size(); ++number) {
    const TreeNode& node = tree.node(number);
    if (!node.leaf()) {
      EXPECT_FALSE(node.chunk);
    } else if (node.chunk) {
      floats += 8 + 6 * node.chunk.room();
    }
  }
  EXPECT_EQ(tree.store().bytes_in_use(), floats * sizeof(float));
}

TEST(TreeSampler, TakesWhereTheSceneHasDetail) {
  TreeSettings settings = settings_of(64, 32);
  settings.exploration = 0;
  TreeSampler sampler(settings);
  std::size_t busy = 0, flat = 0;
  sampler.run(
      [&](double x, double y) {
        busy += x < 16 && y < 16 ? 1 : 0;
        flat += x > 48 ? 1 : 0;
        return scene(x, y);
      },
      4096);
  EXPECT_GT(busy, 4 * flat);
}

TEST(TreeSampler, IsTheSameHoweverItIsCalled) {
  TreeSampler at_once(settings_of(64, 32)), again(settings_of(64, 32));
  at_once.run(scene, 5000);
  // By hand, the values found from last to first.
  while (again.stats().samples < 5000) {
    const std::span<const Request> wave = again.choose(5000 - again.stats().samples);
    std::vector<float> values(3 * wave.size());
    for (std::size_t i = wave.size(); i-- > 0;) {
      const Rgb rgb = scene(wave[i].x, wave[i].y);
      std::copy(rgb.begin(), rgb.end(), values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    again.take_in(values);
  }
  EXPECT_EQ(shape(at_once), shape(again));
}

TEST(TreeSampler, ChoosesAnewWhatWasNotTakenIn) {
  TreeSampler plain(settings_of(64, 32)), undecided(settings_of(64, 32));
  for (int i = 0; i < 300; ++i) {
    const auto take = [](TreeSampler& sampler) {
      const std::span<const Request> wave = sampler.choose(1000);
      std::vector<float> values;
      for (const Request& request : wave) {
        for (const float value : scene(request.x, request.y)) values.push_back(value);
      }
      sampler.take_in(values);
    };
    take(plain);
    undecided.choose(5);
    take(undecided);
  }
  EXPECT_EQ(shape(plain), shape(undecided));
}

TEST(TreeSampler, EndsWhenAllLeavesAreComplete) {
  TreeSettings settings = settings_of(8, 8);
  settings.depth = 1;
  TreeSampler sampler(settings);
  const Places calls = run(sampler, 100000);
  // Four lattices of 17 x 17 points, which have their borders in common; but where a sample was
  // moved from the border within, it is one of two.
  EXPECT_GE(calls.size(), 33u * 33u);
  EXPECT_LE(calls.size(), 33u * 33u + 81u);
  EXPECT_TRUE(sampler.choose(10).empty());
}

TEST(TreeSampler, KeepsNoisyBlocksWhole) {
  TreeSettings settings = settings_of(16, 8);
  settings.noisy = true;
  TreeSampler sampler(settings);
  oracle::Random random(3);
  sampler.run([&](double, double) { return random.values<3>(); }, 100000);
  ASSERT_EQ(sampler.tree().size(), 2u);
  EXPECT_EQ(sampler.tree().node(0).samples, 1089u);
  EXPECT_EQ(sampler.stats().samples, 2u * 1089 - 33);
}

TEST(TreeSampler, LetsNodesGoOnThatARuleSays) {
  struct EveryOther : SplitRule {
    bool goes_on(const NodeTree& tree, std::uint32_t leaf) override {
      EXPECT_EQ(tree.node(leaf).samples, TreeSampler::split_at);
      return tree.node(leaf).block % 2 == 0;
    }
  } rule;
  TreeSampler sampler(settings_of(64, 32), &rule);
  run(sampler, 8000);
  const NodeTree& tree = sampler.tree();
  std::size_t whole = 0;
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const TreeNode& node = tree.node(leaf);
    if (!node.leaf()) continue;
    EXPECT_LE(node.samples, node.block % 2 == 0 ? 289u : 81u);
    whole += node.samples > 81 ? 1 : 0;
  }
  EXPECT_GT(whole, 0u);
}

TEST(TreeSampler, RefusesSettingsAndValuesThatDoNotFit) {
  TreeSettings settings = settings_of(64, 32);
  settings.depth = 6;
  EXPECT_THROW(TreeSampler{settings}, std::invalid_argument);
  settings = settings_of(64, 32);
  settings.weights = {};
  EXPECT_THROW(TreeSampler{settings}, std::invalid_argument);
  settings.weights = {1, -1};
  EXPECT_THROW(TreeSampler{settings}, std::invalid_argument);
  settings = settings_of(std::size_t{1} << 21, 1);
  EXPECT_THROW(TreeSampler{settings}, std::invalid_argument);
  settings = settings_of(64, 32);
  settings.exposure = 0;
  EXPECT_THROW(TreeSampler{settings}, std::invalid_argument);
  TreeSampler empty(settings_of(0, 32));
  EXPECT_TRUE(empty.choose(10).empty());
  TreeSampler sampler(settings_of(64, 32));
  const std::size_t size = sampler.choose(100).size();
  EXPECT_EQ(size, 16u);
  EXPECT_THROW(sampler.take_in(std::vector<float>(3 * size - 1)), std::invalid_argument);
  sampler.take_in(std::vector<float>(3 * size));
  EXPECT_EQ(sampler.stats().samples, size);
}

}  // namespace
}  // namespace freqsynth
