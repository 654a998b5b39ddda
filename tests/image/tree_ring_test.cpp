// SPDX-License-Identifier: MIT
#include "freqsynth/image/tree_ring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/tree_pictures.h"
#include "support/gaussian_process_oracle.h"

namespace freqsynth {
namespace {

constexpr std::size_t side = 24, middle = 4;  // three blocks by three, and the one in the middle

float scene(double x, double y) {
  return static_cast<float>(3 + (x + 0.4 * y > 22.3 ? 1 : 0) + 0.2 * std::sin(0.7 * x));
}

std::unique_ptr<TreeSampler> sampler_of(std::uint64_t samples) {
  TreeSettings settings;
  settings.width = settings.height = side;
  settings.weights = {1};
  settings.wave = 1;
  auto sampler = std::make_unique<TreeSampler>(settings);
  sampler->run(scene, samples);
  return sampler;
}

/// All samples that the block in the middle and its ring have, by their places alone.
struct Known {
  std::vector<UnitPoint> points;  // in the block's unit square
  std::vector<double> values;

  void add(const NodePositions& positions, std::size_t index, int right, int down) {
    const UnitPoint at{positions.s(0, index) + right, positions.t(0, index) + down};
    for (const UnitPoint& other : points) {
      if (other.s == at.s && other.t == at.t) return;
    }
    points.push_back(at);
    values.push_back(double{scene(8 * (at.s + 1), 8 * (at.t + 1))});
  }
};

TEST(TreeRing, PixelsOfABlockAreThoseOfDenseKrigingWithItsRing) {
  const Covariance prior = Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003);
  PriorBank bank;
  bank.add(prior);
  std::size_t compared = 0;
  for (std::uint64_t samples = 240; samples < 1500; samples += 20) {
    const auto sampler = sampler_of(samples);
    const NodeTree& tree = sampler->tree();
    if (!tree.node(middle).leaf() || tree.node(middle).samples > 75) continue;
    std::size_t least = 1089;
    bool any_split = false;
    for (std::uint32_t block = 0; block < 9; ++block) {
      if (block == middle) continue;
      least = std::min<std::size_t>(least, tree.node(block).samples);
      any_split = any_split || !tree.node(block).leaf();
    }
    if (least < 25 || least >= 81) continue;
    if (!any_split || ++compared > 4) continue;
    const NodePositions& positions = tree.positions();
    Known known;
    for (std::size_t i = 0; i < tree.node(middle).samples; ++i) known.add(positions, i, 0, 0);
    const std::size_t own = known.points.size();
    for (int down = -1; down <= 1; ++down) {
      for (int right = -1; right <= 1; ++right) {
        for (std::size_t i = 0; i < 25; ++i) {
          const double s = positions.s(0, i) + right, t = positions.t(0, i) + down;
          const bool outside = s < 0 || s > 1 || t < 0 || t > 1;
          const bool near = s >= -0.5 && s <= 1.5 && t >= -0.5 && t <= 1.5;
          if (outside && near) known.add(positions, i, right, down);
        }
      }
    }
    ASSERT_GT(known.points.size(), own + 20);
    const oracle::GaussianProcess process(prior, known.points, known.values, AverageGrid{});
    TreePictures pictures(positions, {.bank = bank, .blend = 0});
    const std::vector<float> pixels = pictures.pixels(tree);
    const std::vector<float> errors = pictures.errors(tree);
    const float least_error = errors[8 * side + 8];
    for (std::size_t i = 0; i < 64; ++i) {
      const std::size_t pixel = (8 + i / 8) * side + 8 + i % 8;
      ASSERT_NEAR(pixels[pixel], static_cast<float>(process.means[i]), 2e-5) << samples << " " << i;
      // One scale for all: so errors are in proportion to the variances.
      const auto quotient = static_cast<float>(process.variances[i] / process.variances[0]);
      ASSERT_NEAR(errors[pixel] / least_error, quotient, 1e-3f * quotient) << samples << " " << i;
    }
  }
  EXPECT_GE(compared, 4u);
}

TEST(TreeRing, FindsSamplesInWhateverLeafHasThem) {
  std::size_t found = 0, lost = 0;
  for (const std::uint64_t samples : {200u, 900u, 3000u, 20000u}) {
    const auto sampler = sampler_of(samples);
    const NodeTree& tree = sampler->tree();
    const detail::TreeRings rings(tree.positions());
    for (std::uint32_t block = 0; block < 9; ++block) {
      for (std::size_t i = 0; i < NodePositions::size; ++i) {
        const detail::LeafSample sample = rings.find(tree, block, i);
        if (sample.leaf == TreeNode::none) {
          lost += i < tree.node(block).samples ? 1 : 0;
          continue;
        }
        ++found;
        ASSERT_TRUE(tree.node(sample.leaf).leaf());
        ASSERT_EQ(tree.place(sample.leaf, sample.index), tree.place(block, i));
      }
    }
    // Only where the deepest nodes cannot use what a block's samples were moved to.
    if (samples < 3000) {
      ASSERT_EQ(lost, 0u);
    }
  }
  EXPECT_GT(found, 10 * lost);
}

}  // namespace
}  // namespace freqsynth
