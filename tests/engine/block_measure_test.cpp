// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/engine/steering.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "support/block_image.h"
#include "support/oracles.h"
#include "support/refiner_helpers.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using Block = helpers::BlockNumber;
using helpers::BlockImage;
using helpers::different_settings;
using helpers::doubt;
using helpers::feed;
using helpers::gain_of_sample;
using helpers::ScriptedRefiner;
using helpers::tolerance;
using oracle::float_rounding;
using oracle::Real;

TEST(ResidualMeasure, IsTheExpectedGainOfAPooledResidual) {
  for (const PrioritySettings& settings : different_settings()) {
    BlockImage<ScriptedRefiner> image(4, 3, ScriptedRefiner({0.25f, 0, 3}));
    ResidualMeasure measure(settings, 12, 300);
    oracle::Random random(3);
    const std::vector<float> no_residual(3);
    for (Block block = 0; block < 12; ++block) {
      image.blocks.absorb(block, no_residual.data());
      measure.absorbed(image.view(), block, std::array{0.0f});
    }
    int checks = 0;
    const auto check = [&](Block fed) {
      measure.absorbed(image.view(), fed, std::array{1e9f});  // changes do not count
      if (++checks == 40) image.settle(3, 0.7f);
      if (checks % 10 != 0) return;
      Real mean = 0;
      for (Block b = 0; b < 12; ++b) mean += static_cast<Real>(image.blocks.residual(b)) / 12;
      for (Block block = 0; block < 12; ++block) {
        const std::size_t samples = image.blocks.samples(block);
        const auto n = static_cast<Real>(samples);
        const auto own = static_cast<Real>(image.blocks.freedom(block));
        const auto neighbours = static_cast<Real>(settings.neighbours);
        const auto whole = static_cast<Real>(settings.image);
        Real beside = 0;
        for (const Block other : image.beside(block)) {
          beside += static_cast<Real>(image.blocks.residual(other)) /
                    static_cast<Real>(image.beside(block).size());
        }
        const Real residual = (own * static_cast<Real>(image.blocks.residual(block)) +
                               neighbours * beside + whole * mean) /
                              (own + neighbours + whole);
        const auto variance = static_cast<Real>(image.signal.variance());
        const Real least = static_cast<Real>(1e-12) / (n + 1);
        const Real expected = (residual + static_cast<Real>(image.signal.rounding()) +
                               variance * doubt(settings, samples)) *
                                  gain_of_sample(samples) +
                              variance * least;
        ASSERT_NEAR(measure.priority(image.view(), block, 1), static_cast<double>(expected),
                    tolerance(expected))
            << "block " << block << " of " << samples << " samples";
        ASSERT_EQ(measure.priority(image.view(), block, 0.5f),
                  0.5f * measure.priority(image.view(), block, 1));
      }
    };
    feed(image, 1000, random, check);
    EXPECT_EQ(checks, 1000);
  }
}

TEST(ResidualMeasure, SteeredPoolsResidualsAsTheyAreSeen) {
  const std::vector<float> weights{0.25f, 0, 3};
  for (const Steer steer : {Steer::relative, Steer::display}) {
    PrioritySettings settings;
    settings.steer = steer;
    BlockImage<ScriptedRefiner> image(4, 3, ScriptedRefiner(weights));
    Steering steering(settings, false, weights, 12);
    ResidualMeasure measure(settings, 12, 300, steering);
    EXPECT_FALSE(measure.in_units());
    oracle::Random random(3);
    std::vector<Real> seen(12);
    const auto see = [&](Block b) {
      seen[b] = static_cast<Real>(steering.residual(
          image.blocks, b, [&](std::size_t c) { return image.blocks.residual(b, c); }));
    };
    const auto absorbed = [&](Block block) {
      measure.absorbed(image.view(), block, std::array{1e9f});
      if (steering.absorbed(image.blocks, block)) {
        for (Block b = 0; b < 12; ++b) see(b);
      } else if (steering.settled()) {
        see(block);
      }
    };
    const std::vector<float> first{0.5f, 1, 0.02f};
    for (Block block = 0; block < 12; ++block) {
      image.blocks.absorb(block, first.data());
      absorbed(block);
    }
    ASSERT_TRUE(steering.settled());
    feed(image, 2000, random, [&](Block fed) {
      absorbed(fed);
      measure.use_units(image.view(), 4);  // is not asked
      Real mean = 0;
      for (const Real residual : seen) mean += residual / 12;
      Real beside = 0;
      for (const Block other : image.beside(fed)) {
        beside += seen[other] / static_cast<Real>(image.beside(fed).size());
      }
      const std::size_t samples = image.blocks.samples(fed);
      const auto n = static_cast<Real>(samples);
      const auto own = static_cast<Real>(image.blocks.freedom(fed));
      const Real residual = (own * seen[fed] + 16 * beside + mean) / (own + 17);
      const Real least = static_cast<Real>(1e-12) / (n + 1);
      const auto variance = static_cast<Real>(steering.variance());
      const Real rounding = static_cast<Real>(3.25e-12);
      const Real expected =
          std::min(Real{1}, 64 / n) *
          ((residual + rounding + variance * doubt(settings, samples)) * gain_of_sample(samples) +
           variance * least);
      ASSERT_NEAR(measure.priority(image.view(), fed, 1), static_cast<double>(expected),
                  tolerance(expected))
          << "block " << fed << " of " << samples << " samples";
    });
  }
}

TEST(ResidualMeasure, NoiseThatIsNoticedIsNoiseThatWasKnown) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    const PrioritySettings settings{.steer = steer};
    BlockImage<LeastSquaresRefiner> image(3, 2, LeastSquaresRefiner(helpers::shared_list(), 1));
    const auto measure = [&](bool noisy) {
      return ResidualMeasure(settings, 6, 300, Steering(settings, noisy, {1}, 6));
    };
    ResidualMeasure noticed = measure(false), exact = measure(false), known = measure(true);
    oracle::Random random(1);
    // With fewer than 16 samples a block is looked at after each.
    for (int n = 0; n < 15; ++n) {
      for (Block block = 0; block < 6; ++block) {
        const float value = 0.1f * static_cast<float>(block + 1) +
                            0.09f * static_cast<float>(random.uniform(-1, 1));
        image.blocks.absorb(block, &value);
        for (ResidualMeasure* one : {&noticed, &exact, &known}) {
          one->absorbed(image.view(), block, std::array{1.0f});
        }
      }
    }
    EXPECT_TRUE(noticed.notice_noise(image.view()));
    for (Block block = 0; block < 6; ++block) {
      const auto priority = [&](const ResidualMeasure& one) {
        return one.priority(image.view(), block, 1);
      };
      EXPECT_FLOAT_EQ(priority(noticed), priority(known)) << block;
      EXPECT_NE(priority(exact), priority(known)) << block;
    }
  }
  BlockImage<ScriptedRefiner> image(1, 1, ScriptedRefiner({1}));
  ResidualMeasure linear({}, 1, 300);
  EXPECT_FALSE(linear.notice_noise(image.view())) << "it does not ask";
}

TEST(ResidualMeasure, NarrowBlocksCountByTheRootOfTheirArea) {
  BlockImage<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}));
  image.grid = BlockGrid::of(11, 8, 1);  // the second block has 3 of 8 columns
  ResidualMeasure measure({}, 2, 300);
  const float value = 0.5f;
  for (Block block = 0; block < 2; ++block) {
    for (int i = 0; i < 30; ++i) image.blocks.absorb(block, &value);
    measure.absorbed(image.view(), block, std::array{0.0f});
  }
  ASSERT_EQ(image.blocks.residual(0), image.blocks.residual(1));
  const Real whole = static_cast<Real>(measure.priority(image.view(), 0, 1));
  const Real expected = whole * std::sqrt(Real{3} / 8);
  EXPECT_NEAR(measure.priority(image.view(), 1, 1), static_cast<double>(expected),
              tolerance(expected));
}

TEST(ResidualMeasure, WithoutResidualsTheRoundingIsLeft) {
  BlockImage<ScriptedRefiner> image(2, 1, ScriptedRefiner({2}));
  image.settle(1000, 1);
  ASSERT_GT(image.signal.rounding(), 0);
  ResidualMeasure measure({.uncertainty = 0}, 2, 300);
  const float flat = 0;
  for (std::size_t samples = 1; samples <= 200; ++samples) {
    image.blocks.absorb(0, &flat);
    measure.absorbed(image.view(), 0, std::array{0.0f});
    const auto n = static_cast<Real>(samples);
    // Of 2 times the power of a million and one; and least of all the order of the samples.
    const Real rounding = static_cast<Real>(2e-12) * 1000001;
    const Real least = static_cast<Real>(1e-12) / (n + 1);
    const Real expected = rounding * gain_of_sample(samples) + least;
    ASSERT_NEAR(measure.priority(image.view(), 0, 1), static_cast<double>(expected),
                tolerance(expected))
        << samples << " samples";
  }
}

TEST(ResidualMeasure, TellsOfItsResidualsAndListensAlways) {
  BlockImage<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}));
  ResidualMeasure measure({}, 2, 300);
  EXPECT_FALSE(measure.has_news(0));
  const float residual = 2;
  image.blocks.absorb(0, &residual);
  measure.absorbed(image.view(), 0, std::array{0.0f});
  EXPECT_TRUE(measure.has_news(0));
  EXPECT_FALSE(measure.has_news(0));
  EXPECT_TRUE(measure.cares(0));
  EXPECT_TRUE(measure.cares(5));
}

/// The largest values, of alternating signs, with the largest weights.
template <class Measure>
void expect_finite(const PrioritySettings& settings, Measure measure) {
  const LeastSquaresRefiner refiner(helpers::shared_list(), 2, {1e6f, 1e6f});
  BlockImage<LeastSquaresRefiner> image(2, 2, refiner, 400);
  image.settle(0, most_state_value);
  for (int n = 0; n < 400; ++n) {
    for (Block block = 0; block < 4; ++block) {
      const float value = (n + n / 3) % 2 == 0 ? most_state_value : -most_state_value;
      const float values[] = {value, block % 2 == 0 ? value : -value};
      const float change = image.blocks.absorb(block, values);
      measure.absorbed(image.view(), block, std::array{change});
    }
    for (Block block = 0; block < 4; ++block) {
      const float priority = measure.priority(image.view(), block, 1);
      ASSERT_TRUE(std::isfinite(priority))
          << "uncertainty " << settings.uncertainty << ", sample " << n << ": " << priority;
      ASSERT_GT(priority, 0);
    }
  }
}

TEST(BlockMeasures, StayFiniteForTheLargestValuesAndWeights) {
  for (const double uncertainty : {0.0, 1.0, 1e6}) {
    const PrioritySettings settings = {.uncertainty = uncertainty};
    ASSERT_NO_FATAL_FAILURE(expect_finite(settings, ChangeMeasure(settings, 4, 400)));
    ASSERT_NO_FATAL_FAILURE(expect_finite(settings, ResidualMeasure(settings, 4, 400)));
  }
}

}  // namespace
}  // namespace freqsynth
