#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "scenes/scene.h"

namespace {

std::array<float, 3> radiance(const scenes::Scene& scene, double x, double y) {
  std::array<float, 3> rgb{};
  scene.radiance(x, y, rgb);
  return rgb;
}

TEST(Scenes, AreFiniteAndNotNegativeEverywhere) {
  for (const std::string_view name : scenes::scene_names()) {
    const auto scene = scenes::make_scene({.name = std::string(name), .width = 97, .height = 61});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(0, 97), y(0, 61);
    for (int i = 0; i < 20000; ++i) {
      const double at[2] = {x(random), y(random)};
      for (const float value : radiance(*scene, at[0], at[1])) {
        ASSERT_TRUE(std::isfinite(value) && value >= 0) << name << " at " << at[0] << ", " << at[1];
      }
    }
    for (const double cx : {0.0, 97.0}) {
      for (const double cy : {0.0, 61.0}) {
        for (const float value : radiance(*scene, cx, cy)) EXPECT_TRUE(std::isfinite(value));
      }
    }
  }
}

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
  EXPECT_GT(black, 100u);
  EXPECT_LT(black, 300u);
}

TEST(Scenes, RefuseWhatTheyCannotMake) {
  EXPECT_THROW((void)scenes::make_scene({.name = "cheese"}), std::invalid_argument);
  EXPECT_THROW((void)scenes::make_scene({.name = "fan", .width = 0}), std::invalid_argument);
  EXPECT_THROW((void)scenes::make_scene({.name = "image:/nowhere/at/all.png"}), std::runtime_error);
}

}  // namespace
