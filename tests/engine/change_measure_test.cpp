// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/engine/steering.h"
#include "support/block_image.h"
#include "support/oracles.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using Block = helpers::BlockNumber;
using helpers::BlockImage;
using helpers::different_settings;
using helpers::ScriptedRefiner;
using helpers::tolerance;
using helpers::uncertainty;
using oracle::Real;

TEST(ChangeMeasure, IsTheRunningAverageOfEachBlock) {
  for (const PrioritySettings& settings : different_settings()) {
    BlockImage<ScriptedRefiner> image(3, 2, ScriptedRefiner({1}));
    image.settle(0.5f, 2);
    ChangeMeasure measure(settings, 6, 300);
    const auto w = static_cast<Real>(settings.weight);
    std::vector<Real> variations(6);
    Real largest = 0;
    oracle::Random random(1);
    for (int n = 0; n < 500; ++n) {
      const auto block = static_cast<Block>(random.below(6));
      const auto change = static_cast<float>(std::pow(random.uniform(0, 1.5), 6));
      image.blocks.absorb(block, &change);
      measure.absorbed(image.view(), block, std::array{change});
      variations[block] = (1 - w) * variations[block] + w * static_cast<Real>(change);
      largest = std::max(largest, static_cast<Real>(change));
      const float factor = 0.25f * static_cast<float>(random.below(5));
      const std::size_t samples = image.blocks.samples(block);
      const Real u = static_cast<Real>(image.signal.variance()) *
                     (uncertainty(settings, samples) +
                      static_cast<Real>(1e-12) / static_cast<Real>(samples + 1));
      const Real expected = static_cast<Real>(factor) * (variations[block] + u);
      // The running average forgets its roundings as it forgets its values.
      ASSERT_NEAR(measure.priority(image.view(), block, factor), static_cast<double>(expected),
                  tolerance(expected + largest / w))
          << "sample " << n;
    }
  }
}

TEST(ChangeMeasure, HasNothingToTell) {
  BlockImage<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}));
  ChangeMeasure measure({}, 2, 300);
  measure.absorbed(image.view(), 0, std::array{1000.0f});
  EXPECT_FALSE(measure.has_news(0));
  EXPECT_FALSE(measure.cares(1));
  EXPECT_FALSE(measure.cares(0));
}

TEST(ChangeMeasure, EndlessChangeStaysANumber) {
  BlockImage<ScriptedRefiner> image(1, 1, ScriptedRefiner({1}));
  image.settle(0, 1e15f);
  ChangeMeasure measure({.uncertainty = 1e6}, 1, 300);
  const float value = 1;
  float priority = 0;
  for (int n = 0; n < 300; ++n) {
    image.blocks.absorb(0, &value);
    measure.absorbed(image.view(), 0, std::array{std::numeric_limits<float>::infinity()});
    priority = measure.priority(image.view(), 0, 1);
    ASSERT_TRUE(std::isfinite(priority)) << "sample " << n;
    ASSERT_GT(priority, 1e25f);
  }
  // It is forgotten like any other.
  for (int n = 0; n < 100; ++n) measure.absorbed(image.view(), 0, std::array{0.0f});
  EXPECT_LT(measure.priority(image.view(), 0, 1), 1e-3f * priority);
}

TEST(ChangeMeasure, SteeredCountsChangesAsTheyAreSeen) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    PrioritySettings settings;
    settings.steer = steer;
    BlockImage<ScriptedRefiner> image(2, 2, ScriptedRefiner({2}));
    Steering steering(settings, false, {2}, 4);
    ChangeMeasure measure(settings, 4, 300, steering);
    EXPECT_FALSE(measure.in_units());
    std::vector<Real> variations(4);
    const auto w = static_cast<Real>(settings.weight);
    oracle::Random random(1);
    for (int n = 0; n < 300; ++n) {
      // At first each block in turn.
      const auto block = static_cast<Block>(n < 4 ? n : static_cast<int>(random.below(4)));
      const auto change = static_cast<float>(std::pow(random.uniform(0, 0.5), 6));
      image.blocks.absorb(block, &change);
      const float seen = steering.settled() ? steering.change(image.blocks, block, change) : change;
      variations[block] = (1 - w) * variations[block] + w * static_cast<Real>(seen);
      if (steering.absorbed(image.blocks, block)) {
        for (Block b = 0; b < 4; ++b) {
          variations[b] = static_cast<Real>(
              steering.change(image.blocks, b, static_cast<float>(variations[b])));
        }
      }
      measure.absorbed(image.view(), block, std::array{change});
      measure.use_units(image.view(), steering.settled() ? 4.0f : 1.0f);  // is not asked
      const std::size_t samples = image.blocks.samples(block);
      const Real u = static_cast<Real>(steering.variance()) *
                     (uncertainty(settings, samples) +
                      static_cast<Real>(1e-12) / static_cast<Real>(samples + 1));
      const Real expected = variations[block] + u;
      ASSERT_NEAR(measure.priority(image.view(), block, 1), static_cast<double>(expected),
                  tolerance(expected + Real{0.1L}))
          << "sample " << n;
    }
  }
}

}  // namespace
}  // namespace freqsynth
