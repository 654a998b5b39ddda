// SPDX-License-Identifier: MIT
// What every scene must do.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "scene_helpers.h"
#include "scenes/scene.h"

namespace {

using scene_helpers::Color;
using scene_helpers::make;
using scene_helpers::noisy_names;
using scene_helpers::radiance;
using scene_helpers::Samples;

TEST(Scenes, AreFiniteAndNotNegativeEverywhere) {
  constexpr std::array<std::array<int, 2>, 4> sizes{{{97, 61}, {1, 1}, {3, 200}, {300, 2}}};
  for (const std::string_view name : scenes::scene_names()) {
    for (const auto& [width, height] : sizes) {
      const auto scene = make(name, width, height);
      Samples at(5000, width, height);
      for (const double x : {0, width}) {
        for (const double y : {0, height}) {
          at.x.push_back(x);
          at.y.push_back(y);
          at.id.push_back(0);
        }
      }
      for (std::size_t i = 0; i < at.x.size(); ++i) {
        for (const float value : radiance(*scene, at.x[i], at.y[i], at.id[i])) {
          ASSERT_TRUE(std::isfinite(value) && value >= 0)
              << name << " at " << at.x[i] << ", " << at.y[i];
        }
      }
    }
  }
}

// Two objects, the second used by several threads, each in an order of its own.
TEST(Scenes, GiveTheSameValueWhoeverAsks) {
  constexpr std::size_t count = 2000;
  constexpr std::size_t threads = 4;
  const Samples at(count, 97, 61);
  for (const std::string_view name : scenes::scene_names()) {
    const auto scene = make(name, 97, 61);
    std::vector<Color> expected;
    for (std::size_t i = 0; i < count; ++i) {
      expected.push_back(radiance(*scene, at.x[i], at.y[i], at.id[i]));
    }
    const auto shared = make(name, 97, 61);
    std::array<std::size_t, threads> different{};
    {
      std::vector<std::jthread> running;
      for (std::size_t thread = 0; thread < threads; ++thread) {
        running.emplace_back([&, thread] {
          for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = (count * thread / threads + count - 1 - k) % count;
            if (radiance(*shared, at.x[i], at.y[i], at.id[i]) != expected[i]) ++different[thread];
          }
        });
      }
    }
    for (const std::size_t each : different) EXPECT_EQ(each, 0u) << name;
  }
}

TEST(Scenes, SayWhetherTheyAreNoisy) {
  const Samples at(1000, 97, 61);
  for (const std::string_view name : scenes::scene_names()) {
    const auto scene = make(name, 97, 61);
    EXPECT_EQ(scene->noisy(), noisy_names.contains(name)) << name;
    std::size_t different = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const Color one = radiance(*scene, at.x[i], at.y[i], at.id[i]);
      if (one != radiance(*scene, at.x[i], at.y[i], at.id[i] + 1)) ++different;
    }
    if (scene->noisy()) {
      EXPECT_GT(different, 480u) << name << ": 599 of the 1000 were measured for cornell, where"
                                 << " there is nothing beside the box";
    } else {
      EXPECT_EQ(different, 0u) << name;
    }
  }
}

TEST(Scenes, LookTheSameAtEverySize) {
  constexpr std::size_t count = 2000;
  const Samples at(count, 64, 48);
  // Not the zone plates, whose frequency is given per pixel, nor the dots.
  for (const std::string_view name : {"fan", "chess", "star", "checker", "gradient", "corner",
                                      "edge", "sun", "softshadow", "dof", "glossy"}) {
    const auto small = make(name, 64, 48);
    const auto large = make(name, 256, 192);
    std::size_t different = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Color a = radiance(*small, at.x[i], at.y[i], at.id[i]);
      const Color b = radiance(*large, 4 * at.x[i], 4 * at.y[i], at.id[i]);
      for (std::size_t c = 0; c < 3; ++c) {
        if (std::abs(a[c] - b[c]) > 1e-4f * (1 + a[c])) ++different;
      }
    }
    // None was seen. Rounding may put a sample on the other side of an edge.
    EXPECT_LE(different, 3u) << name;
  }
}

TEST(Scenes, AreAllListed) {
  const auto names = scenes::scene_names();
  const std::set<std::string_view> listed(names.begin(), names.end());
  EXPECT_EQ(listed.size(), names.size());
  EXPECT_EQ(listed,
            (std::set<std::string_view>{"fan", "chess", "zoneplate", "zoneplate-high", "star",
                                        "edge", "checker", "gradient", "dot", "corner", "sun",
                                        "softshadow", "dof", "glossy", "cornell", "spheres"}));
  for (const std::string_view name : names) {
    EXPECT_NE(scenes::scene_list().find(name), std::string::npos);
  }
}

TEST(Scenes, RefuseWhatTheyCannotMake) {
  try {
    (void)make("cheese", 8, 8);
    FAIL() << "a cheese";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'cheese'"), std::string::npos) << text;
    EXPECT_NE(text.find(scenes::scene_list()), std::string::npos) << text;
  }
  EXPECT_THROW((void)scenes::make_scene({.name = "image:"}), std::invalid_argument);
  for (const std::string_view name : scenes::scene_names()) {
    EXPECT_THROW((void)make(name, 0, 8), std::invalid_argument);
    EXPECT_THROW((void)make(name, 8, -1), std::invalid_argument);
  }
  EXPECT_THROW((void)scenes::make_scene({.name = "image:/nowhere/at/all.png"}), std::runtime_error);
}

}  // namespace
