// SPDX-License-Identifier: MIT
// What each of the scenes shows.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>

#include "scene_helpers.h"
#include "scenes/scene.h"

namespace {

using scene_helpers::Color;
using scene_helpers::make;
using scene_helpers::radiance;

TEST(Scenes, FanIsBlackAndWhiteAndMirrorsLeftToRight) {
  const auto scene = scenes::make_scene({.name = "fan", .width = 512, .height = 512});
  std::size_t black = 0;
  for (int i = 0; i < 512; ++i) {
    const double x = i + 0.3;
    const double y = 100.7;
    const auto left = radiance(*scene, x, y);
    EXPECT_TRUE(left[0] == 0 || left[0] == 1);
    EXPECT_EQ(left, radiance(*scene, 512 - x, y)) << x;
    if (left[0] == 0) ++black;
  }
  // 196 were measured.
  EXPECT_GT(black, 157u);
  EXPECT_LT(black, 245u);
}

TEST(Scenes, ZonePlateReachesItsFrequencyAtTheFarCorner) {
  // Crossings of the mean over the last 40 pixels of the diagonal: two per cycle.
  const auto crossings = [](const scenes::Scene& scene) {
    int count = 0;
    bool above = false;
    for (int i = 0; i <= 4000; ++i) {
      const double along = (724 - 40 + i * 0.01) / std::numbers::sqrt2;
      const bool now = radiance(scene, along, along)[0] > 0.5f;
      if (i > 0 && now != above) ++count;
      above = now;
    }
    return count;
  };
  const auto expected = [](double frequency) { return 2 * 40 * frequency * (724 - 20) / 724; };
  EXPECT_NEAR(crossings(*make("zoneplate", 512, 512)), expected(0.4), 1);
  EXPECT_NEAR(crossings(*make("zoneplate-high", 512, 512)), expected(0.8), 1);
  scenes::SceneOptions options{.name = "zoneplate", .zone_frequency = 0.2};
  EXPECT_NEAR(crossings(*scenes::make_scene(options)), expected(0.2), 1);
  options.name = "zoneplate-high";
  EXPECT_NEAR(crossings(*scenes::make_scene(options)), expected(0.8), 1) << "has its own";
}

// Each edge of a spoke is a ray from the star's centre: it meets a circle about it just once.
TEST(Scenes, StarHas37Spokes) {
  const auto scene = make("star", 400, 400);
  for (const double radius : {30, 120, 170}) {
    int changes = 0;
    float before = -1;
    for (int i = 0; i <= 7200; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / 7200;
      const float now =
          radiance(*scene, 200 + radius * std::cos(angle), 200 + radius * std::sin(angle))[0];
      if (before >= 0 && now != before) ++changes;
      before = now;
    }
    EXPECT_EQ(changes, 74) << radius;
  }
  EXPECT_EQ(radiance(*scene, 3, 3)[0], 1);
}

TEST(Scenes, EdgeLeansByFiveDegrees) {
  const auto scene = make("edge", 300, 200);
  const auto black_until = [&](double y) {
    double x = 0;
    while (radiance(*scene, x, y)[0] == 0) x += 0.01;
    return x;
  };
  const double angle = std::atan2(black_until(0) - black_until(200), 200);
  EXPECT_NEAR(angle * 180 / std::numbers::pi, 5, 0.01);
}

// In points on a grid, not by the closed form, which may share its mistakes.
TEST(Scenes, DotsHaveTheEnergyOfTheirArea) {
  const auto scene = make("dot", 128, 96);
  constexpr int side = 12;
  int bright = 0;
  for (int i = 0; i < 128 * side; ++i) {
    for (int j = 0; j < 96 * side; ++j) {
      const float value = radiance(*scene, (i + 0.5) / side, (j + 0.5) / side)[0];
      if (value == 3.0f) {
        ++bright;
      } else {
        ASSERT_EQ(value, 0.18f);
      }
    }
  }
  const double area = 49 * std::numbers::pi * 0.09;
  EXPECT_NEAR(bright / double{side * side}, area, 0.03 * area);
}

TEST(Scenes, CheckerHasTwoColoursBelowTheHorizonOnly) {
  const auto scene = make("checker", 200, 200);
  const auto colors_between = [&](int top, int bottom) {
    std::set<Color> colors;
    for (int y = top; y < bottom; ++y) {
      for (int x = 0; x < 200; ++x) colors.insert(radiance(*scene, x + 0.5, y + 0.5));
    }
    return colors.size();
  };
  EXPECT_GT(colors_between(0, 50), 4000u) << "5000 were measured";
  EXPECT_EQ(colors_between(100, 200), 2u);
}

TEST(Scenes, SunIsSmallAndAThousandTimesAsBrightAsTheSky) {
  const auto scene = make("sun", 200, 200);
  int sun = 0, sky = 0, dark = 0;
  for (int i = 0; i < 200 * 200; ++i) {
    const float value = radiance(*scene, i % 200 + 0.5, i / 200 + 0.5)[0];
    if (value == 1000) {
      ++sun;
    } else if (value < 0.02f) {
      ++dark;
    } else {
      EXPECT_LT(value, 4);
      ++sky;
    }
  }
  // A disc of 7 pixels radius, of which firs cover a little: 145 were measured.
  EXPECT_GT(sun, 116);
  EXPECT_LE(sun, 154);
  // 11332 and 28523 were measured.
  EXPECT_GT(dark, 9000);
  EXPECT_GT(sky, 23000);
}

}  // namespace
