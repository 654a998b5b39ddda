// SPDX-License-Identifier: MIT
#include "freqsynth/image/tree_pictures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/node_pixels.h"
#include "freqsynth/image/reconstructor.h"

namespace freqsynth {
namespace {

std::array<float, 2> scene(double x, double y) {
  const float edge = x + 0.4 * y > 9.2 ? 1.0f : 0.0f;
  return {edge, static_cast<float>(0.2 * std::sin(0.3 * x) + 0.1 * y)};
}

/// A small bank, so that its lists are built soon.
PriorBank small_bank() {
  PriorBank bank;
  bank.add(Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003));
  bank.add(Covariance::isotropic(CovarianceShape::matern52, 1.5, 1e-4));
  return bank;
}

TEST(TreePictures, AreWhatTheEstimatorMakesOfEachLeaf) {
  TreeSettings settings;
  settings.width = 19;
  settings.height = 16;
  settings.weights = {1, 1};
  settings.wave = 4;
  TreeSampler sampler(settings);
  sampler.run(scene, 1500);
  const NodeTree& tree = sampler.tree();
  TreePictures pictures(tree.positions(), {.bank = small_bank(), .ring = false, .blend = 0});
  const std::vector<float> pixels = pictures.pixels(tree);
  ASSERT_EQ(pixels.size(), 19u * 16 * 2);
  EXPECT_GT(pictures.memory(), 0u);
  // One leaf at a time, from lists of its own.
  const auto alone = [&](std::uint32_t leaf, std::size_t channel, std::span<float> parts) {
    const TreeNode& node = tree.node(leaf);
    if (node.samples == 0 || tree.waits(leaf)) {
      std::fill(parts.begin(), parts.end(), tree.known_mean(leaf, channel));
      return;
    }
    std::vector<UnitPoint> points;
    std::vector<float> values;
    for (std::size_t i = 0; i < node.samples; ++i) {
      points.push_back({tree.positions().s(node.of, i), tree.positions().t(node.of, i)});
      for (std::size_t c = 0; c < 2; ++c) values.push_back(tree.values(leaf, c)[i]);
    }
    const std::size_t side = tree.positions().pixels(node.of);
    const BankLists lists(small_bank(), points, AverageGrid::of_node(side));
    std::vector<float> averages(2 * side * side);
    BankNode one;
    one.values = values.data();
    one.count = node.samples;
    one.averages = averages.data();
    BankEstimator(lists, 2).estimate(std::span(&one, 1));
    std::copy_n(averages.data() + channel * side * side, side * side, parts.begin());
  };
  SerialExecutor serial;
  EXPECT_EQ(pixels, node_pixels(tree, serial, alone));
  // And it is a picture of the scene.
  double squares = 0;
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 19; ++x) {
      double right = 0;
      for (int i = 0; i < 64; ++i) {
        right += double{scene(static_cast<double>(x) + (i % 8 + 0.5) / 8,
                              static_cast<double>(y) + (i / 8 + 0.5) / 8)[0]} /
                 64;
      }
      squares += std::pow(double{pixels[2 * (y * 19 + x)]} - right, 2);
    }
  }
  EXPECT_LT(std::sqrt(squares / (19 * 16)), 0.02);
}

TreeSettings settings_of(std::size_t width, std::size_t height) {
  TreeSettings settings;
  settings.width = width;
  settings.height = height;
  settings.weights = {1, 1};
  settings.wave = 16;
  return settings;
}

TEST(TreePictures, AreTheSameForAnyExecutorAndWhateverWasMadeBefore) {
  TreeSampler sampler(settings_of(75, 50));
  ThreadPool pool(3);
  TreePictures kept(sampler.tree().positions(), small_bank());
  for (const std::uint64_t samples : {300u, 700u, 701u, 2000u, 6000u, 12000u}) {
    sampler.run(scene, samples);
    const NodeTree& tree = sampler.tree();
    TreePictures fresh(tree.positions(), small_bank());
    const std::vector<float> pixels = fresh.pixels(tree), errors = fresh.errors(tree);
    ASSERT_EQ(kept.pixels(tree, pool), pixels) << samples;
    ASSERT_EQ(kept.errors(tree, pool), errors) << samples;
    ASSERT_EQ(kept.pixels(tree), pixels) << samples;
    SerialExecutor serial;
    ASSERT_EQ(rough_pixels(tree, pool), rough_pixels(tree, serial)) << samples;
  }
}

TEST(TreePictures, AreAFrequencyImageWithTheSamePixels) {
  TreeSampler sampler(settings_of(37, 20));
  sampler.run(scene, 1500);
  TreePictures pictures(sampler.tree().positions(), small_bank());
  SerialExecutor serial;
  const std::vector<float> pixels = pictures.pixels(sampler.tree());
  const FrequencyImage image = pictures.image(sampler.tree(), serial);
  EXPECT_EQ(image.meaning(), CoefficientMeaning::pixel_average);
  const std::vector<float> back = reconstruct(image);
  ASSERT_EQ(back.size(), pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) ASSERT_NEAR(back[i], pixels[i], 1e-5) << i;
}

}  // namespace
}  // namespace freqsynth
