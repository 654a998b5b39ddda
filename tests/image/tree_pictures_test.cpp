// SPDX-License-Identifier: MIT
#include "freqsynth/image/tree_pictures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
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

float plane(double x, double y) { return static_cast<float>(0.01 * x - 0.03 * y); }

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

TEST(TreePictures, AConstantStaysOneAndAPlaneIsOne) {
  TreeSampler sampler(settings_of(72, 40));
  sampler.run([](double x, double y) { return std::array<float, 2>{0.7f, plane(x, y)}; }, 2880);
  TreePictures pictures(sampler.tree().positions());
  const std::vector<float> pixels = pictures.pixels(sampler.tree());
  for (std::size_t i = 0; i < 72 * 40; ++i) {
    ASSERT_FLOAT_EQ(pixels[2 * i], 0.7f);
    const double x = static_cast<double>(i % 72) + 0.5, y = static_cast<double>(i / 72) + 0.5;
    ASSERT_NEAR(pixels[2 * i + 1], plane(x, y), 1e-4) << i;
  }
}

/// Of a grain that no leaf can follow: the mean step across borders of blocks, over that within.
double step_at_borders(const BankPictureSettings& settings) {
  TreeSettings whole = settings_of(96, 96);
  whole.depth = 0;
  TreeSampler sampler(whole);
  const auto grain = [](double x, double y) {
    const double value = std::sin(311 * x + 97 * y) * 43758.5453;
    return std::array<float, 2>{static_cast<float>(value - std::floor(value)), 0};
  };
  sampler.run(grain, 96 * 96 / 2);
  TreePictures pictures(sampler.tree().positions(), settings);
  const std::vector<float> pixels = pictures.pixels(sampler.tree());
  double sums[2] = {}, counts[2] = {};
  for (std::size_t y = 0; y < 96; ++y) {
    for (std::size_t x = 0; x + 1 < 96; ++x) {
      const std::size_t border = x % 8 == 7 ? 1 : 0, i = 2 * (y * 96 + x);
      sums[border] += std::abs(double{pixels[i + 2]} - double{pixels[i]});
      ++counts[border];
    }
  }
  return sums[1] / counts[1] * counts[0] / sums[0];
}

TEST(TreePictures, HaveNoStepsAtBorders) {
  PriorBank bank;
  bank.add(Covariance::isotropic(CovarianceShape::exponential, 2, 3));
  EXPECT_GT(step_at_borders({.bank = bank, .ring = false, .blend = 0}), 1.5);
  EXPECT_LT(step_at_borders({.bank = bank}), 1.2);
}

TEST(TreePictures, TellHowFarTheyAreOff) {
  const auto waves = [](double x, double y) {
    return std::array<float, 2>{static_cast<float>(std::sin(0.5 * x) * std::cos(0.3 * y)),
                                static_cast<float>(std::hypot(x - 30, y - 31) < 17 ? 1 : 0)};
  };
  TreeSampler sampler(settings_of(64, 64));
  TreePictures pictures(sampler.tree().positions());
  double before = 1e9;
  for (const std::uint64_t samples : {1000u, 4000u, 16000u}) {
    sampler.run(waves, samples);
    const std::vector<float> pixels = pictures.pixels(sampler.tree());
    const std::vector<float> errors = pictures.errors(sampler.tree());
    ASSERT_EQ(errors.size(), 64u * 64);
    double expected = 0, real = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      ASSERT_GE(errors[i], 0);
      expected += double{errors[i]};
      std::array<double, 2> right{};
      for (int k = 0; k < 256; ++k) {
        const auto value = waves(static_cast<double>(i % 64) + (k % 16 + 0.5) / 16,
                                 static_cast<double>(i / 64) + (k / 16 + 0.5) / 16);
        for (std::size_t c = 0; c < 2; ++c) right[c] += double{value[c]} / 256;
      }
      for (std::size_t c = 0; c < 2; ++c) {
        real += std::pow(double{pixels[2 * i + c]} - right[c], 2) / 2;
      }
    }
    const double quotient = std::sqrt(expected / real);
    EXPECT_GT(quotient, 0.6) << samples;
    EXPECT_LT(quotient, 1.7) << samples;
    EXPECT_LT(expected, before);
    before = expected;
  }
}

TEST(TreePictures, RefuseABlendThatIsTooWide) {
  const NodePositions positions;
  EXPECT_THROW(TreePictures(positions, {.blend = 5}), std::invalid_argument);
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
