// SPDX-License-Identifier: MIT
#include "freqsynth/image/node_pixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "freqsynth/engine/tree_sampler.h"
#include "support/gaussian_process_oracle.h"

namespace freqsynth {
namespace {

TreeSettings settings_of(std::size_t width, std::size_t height) {
  TreeSettings settings;
  settings.width = width;
  settings.height = height;
  settings.weights = {1};
  settings.wave = 8;
  return settings;
}

SerialExecutor serial;

float spot(double x, double y) { return std::hypot(x - 5.3, y - 6.1) < 2 ? 1.0f : 0.0f; }

TEST(NodePixels, AreMadeOfPartsByArea) {
  for (const std::size_t width : {8u, 16u, 21u, 5u}) {
    TreeSampler sampler(settings_of(width, 19));
    sampler.run(spot, 3000);
    const NodeTree& tree = sampler.tree();
    const auto ones = [](std::uint32_t, std::size_t, std::span<float> parts) {
      for (float& part : parts) part = 1;
    };
    for (const float pixel : node_pixels(tree, serial, ones)) ASSERT_NEAR(pixel, 1, 1e-6);
    // The averages of x are those of pixels where these are made of whole parts.
    const auto means_of_x = [&](std::uint32_t leaf, std::size_t, std::span<float> parts) {
      const TreeNode& node = tree.node(leaf);
      const auto side = tree.positions().pixels(node.of);
      const double edge =
          static_cast<double>(tree.grid().block_width(node.block)) / std::ldexp(1.0, node.depth);
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const double at = (static_cast<double>(i % side) + 0.5) / static_cast<double>(side);
        parts[i] = static_cast<float>(8.0 * static_cast<double>(tree.grid().column(node.block)) +
                                      edge * (node.column + at));
      }
    };
    const std::vector<float> pixels = node_pixels(tree, serial, means_of_x);
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      sum += double{pixels[i]};
      const double x = static_cast<double>(i % width) + 0.5;
      const bool whole = i % width < width / 8 * 8;
      ASSERT_NEAR(pixels[i], x, whole ? 1e-5 : 0.5) << width << " " << i;
    }
    // None of it is lost.
    EXPECT_NEAR(sum, 19.0 * static_cast<double>(width * width) / 2, 1e-3 * sum);
  }
}

TEST(NodePixels, OfTheRoughPriorAreThoseOfDenseKriging) {
  TreeSampler sampler(settings_of(16, 8));
  sampler.run([](double x, double y) { return 100 + spot(x, y); }, 400);
  const NodeTree& tree = sampler.tree();
  std::size_t leaves = 0;
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const TreeNode& node = tree.node(leaf);
    if (!node.leaf() || node.samples == 0 || node.samples > 60) continue;
    ++leaves;
    std::vector<UnitPoint> points;
    for (std::size_t i = 0; i < node.samples; ++i) {
      points.push_back({tree.positions().s(node.of, i), tree.positions().t(node.of, i)});
    }
    const std::span<const float> values = tree.values(leaf, 0);
    const std::size_t side = tree.positions().pixels(node.of);
    const oracle::GaussianProcess process(tree.refiner().list(node.of).covariance(), points,
                                          std::vector<double>(values.begin(), values.end()),
                                          AverageGrid::of_node(side));
    std::vector<float> averages(side * side);
    rough_averages(tree, leaf, 0, averages);
    for (std::size_t i = 0; i < averages.size(); ++i) {
      ASSERT_NEAR(averages[i], static_cast<float>(process.means[i]), 3e-5) << leaf << " " << i;
    }
  }
  EXPECT_GT(leaves, 3u);
}

TEST(NodePixels, OfDeepLeavesThatWaitForACornerAreWhatTheyWereHanded) {
  TreeSampler sampler(settings_of(16, 8));
  std::size_t waiting = 0;
  for (std::uint64_t samples = 200; samples < 6000; samples += 7) {
    sampler.run([](double x, double y) { return 10 + spot(x, y); }, samples);
    const NodeTree& tree = sampler.tree();
    for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
      if (!tree.node(leaf).leaf() || !tree.waits(leaf)) continue;
      ++waiting;
      float mean = 0;
      rough_averages(tree, leaf, 0, std::span(&mean, 1));
      ASSERT_GE(mean, 10);
      ASSERT_LE(mean, 11);
      ASSERT_EQ(mean, tree.known_mean(leaf, 0));
    }
  }
  EXPECT_GT(waiting, 10u);
}

}  // namespace
}  // namespace freqsynth
