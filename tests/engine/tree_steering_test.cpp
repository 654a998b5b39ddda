// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "freqsynth/engine/tree_sampler.h"
#include "support/tree_helpers.h"

namespace freqsynth {
namespace {

using tree_helpers::Rgb;
using tree_helpers::scene;
using tree_helpers::settings_of;
using tree_helpers::shape;

TEST(TreeSteering, FollowsTheUnitOfTheSignal) {
  TreeSampler plain(settings_of(64, 32)), large(settings_of(64, 32));
  plain.run(scene, 4000);
  large.run(
      [](double x, double y) {
        Rgb rgb = scene(x, y);
        for (float& value : rgb) value *= 0x1p20f;
        return rgb;
      },
      4000);
  EXPECT_EQ(shape(plain), shape(large));
}

TEST(TreeSteering, PassesOverChannelsWithoutAWeight) {
  TreeSettings settings = settings_of(64, 32);
  settings.weights = {1, 0, 0};
  TreeSampler plain(settings), other(settings);
  plain.run(scene, 4000);
  other.run(
      [](double x, double y) {
        return Rgb{scene(x, y)[0], static_cast<float>(std::sin(1e3 * x * y)), 7};
      },
      4000);
  EXPECT_EQ(shape(plain), shape(other));
}

TEST(TreeSteering, SteersByWhatIsSeen) {
  const auto calls_in_spot = [](Steer steer) {
    TreeSettings settings = settings_of(64, 32);
    settings.steer = steer;
    TreeSampler sampler(settings);
    std::size_t calls = 0;
    sampler.run(
        [&](double x, double y) {
          calls += std::hypot(x - 40, y - 20) < 6 ? 1 : 0;
          return scene(x, y);
        },
        4000);
    return calls;
  };
  EXPECT_LT(calls_in_spot(Steer::display), calls_in_spot(Steer::linear));
  EXPECT_LT(calls_in_spot(Steer::relative), calls_in_spot(Steer::linear));
}

TEST(TreeSteering, SurvivesValuesThatAreNotUsable) {
  TreeSampler sampler(settings_of(64, 32));
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(), 1e30f};
  std::uint64_t calls = 0, count = 0;
  sampler.run(
      [&](double x, double y) {
        Rgb rgb = scene(x, y);
        if (++calls % 7 == 0) {
          rgb[calls % 3] = bad[calls % 2 + (calls % 5 == 0 ? 1 : 0)];
          ++count;
        }
        return rgb;
      },
      4000);
  EXPECT_EQ(sampler.stats().bad, count);
  for (std::uint32_t leaf = 0; leaf < sampler.tree().size(); ++leaf) {
    if (!sampler.tree().node(leaf).leaf()) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      for (const float value : sampler.tree().values(leaf, c)) {
        ASSERT_LE(std::abs(value), 100);
      }
    }
  }
}

}  // namespace
}  // namespace freqsynth
