// SPDX-License-Identifier: MIT
// What noisy scenes tell of the first surface that a sample meets.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string_view>
#include <vector>

#include "scene_helpers.h"
#include "scenes/camera.h"
#include "scenes/scene.h"
#include "scenes/vec3.h"

namespace {

using scene_helpers::make;
using scene_helpers::noisy_names;
using scene_helpers::radiance;
using scene_helpers::Samples;
using scenes::Vec3;

struct Features {
  Vec3 color, normal;
  double nearness;
};

std::vector<float> values_of(const scenes::Scene& scene, double x, double y, std::uint64_t id) {
  std::vector<float> values(3 + scene.features(), -1.0f);
  scene.radiance_and_features(x, y, id, values);
  return values;
}

Features features_of(const scenes::Scene& scene, double x, double y, std::uint64_t id) {
  const std::vector<float> values = values_of(scene, x, y, id);
  const auto vector = [&](std::size_t i) {
    return Vec3{double{values[i]}, double{values[i + 1]}, double{values[i + 2]}};
  };
  return {vector(3), vector(6), double{values[9]}};
}

bool is_near(const Vec3& a, const Vec3& b, double most = 1e-5) { return length(a - b) < most; }

TEST(Features, ComeBehindTheRadianceAndOnlyWhereThereIsNoise) {
  const Samples at(300, 97, 61);
  for (const std::string_view name : scenes::scene_names()) {
    const auto scene = make(name, 97, 61);
    ASSERT_EQ(scene->features(), noisy_names.contains(name) ? scenes::feature_count : 0) << name;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const auto rgb = radiance(*scene, at.x[i], at.y[i], at.id[i]);
      const auto values = values_of(*scene, at.x[i], at.y[i], at.id[i]);
      ASSERT_TRUE(std::equal(rgb.begin(), rgb.end(), values.begin())) << name;
    }
  }
}

TEST(Features, AreThoseOfASurfaceOrAllZero) {
  const Samples at(2000, 97, 61);
  for (const std::string_view name : noisy_names) {
    const auto scene = make(name, 97, 61);
    std::size_t met = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const auto [color, normal, nearness] = features_of(*scene, at.x[i], at.y[i], at.id[i]);
      if (nearness == 0) {
        ASSERT_TRUE(length(color) == 0 && length(normal) == 0) << name;
        continue;
      }
      ++met;
      ASSERT_NEAR(length(normal), 1, 1e-6) << name;
      for (const double share : {color.x, color.y, color.z}) {
        ASSERT_TRUE(share >= 0 && share <= 1) << name;
      }
      ASSERT_TRUE(nearness > 0 && nearness < 1e9) << name;
    }
    EXPECT_GT(met, 500u) << name;
  }
}

TEST(Features, SayWhereTheSurfaceIs) {
  // The camera, the red ball and the floor of soft_shadow.cpp.
  const scenes::Camera camera({1.5, -8.5, 4.6}, {0.15, 0.2, 0.75}, 0.33, 97, 61);
  const auto scene = make("softshadow", 97, 61);
  std::size_t on_ball = 0, on_floor = 0;
  const Samples at(4000, 97, 61);
  for (std::size_t i = 0; i < at.x.size(); ++i) {
    const scenes::Ray ray = camera.ray(at.x[i], at.y[i]);
    const auto [color, normal, nearness] = features_of(*scene, at.x[i], at.y[i], at.id[i]);
    if (nearness == 0) continue;
    ASSERT_LT(dot(normal, ray.direction), 1e-6);
    const Vec3 point = ray.at(1 / nearness);
    if (is_near(color, {0.75, 0.16, 0.10})) {
      ++on_ball;
      ASSERT_TRUE(is_near(point - 0.9 * normal, {-1.5, 0.3, 0.9}));
    } else if (std::abs(point.z) < 1e-4 && normal.z == 1) {
      ++on_floor;
      const bool light = std::fmod(std::floor(point.x) + std::floor(point.y), 2.0) == 0;
      const Vec3 tile = light ? Vec3{0.72, 0.70, 0.66} : Vec3{0.56, 0.55, 0.53};
      const double to_line = std::min(std::abs(point.x - std::round(point.x)),
                                      std::abs(point.y - std::round(point.y)));
      ASSERT_TRUE(is_near(color, tile) || to_line < 1e-4);
    }
  }
  EXPECT_GT(on_ball, 100u);
  EXPECT_GT(on_floor, 1000u);
}

TEST(Features, GoThroughTheLens) {
  // The first surface depends on the id only where a lens decides what it is.
  const Samples at(300, 97, 61);
  for (const std::string_view name : noisy_names) {
    const auto scene = make(name, 97, 61);
    std::size_t different = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const auto one = features_of(*scene, at.x[i], at.y[i], at.id[i]);
      const auto other = features_of(*scene, at.x[i], at.y[i], at.id[i] + 1);
      different += one.nearness != other.nearness;
    }
    if (name == "dof" || name == "spheres") {
      EXPECT_GT(different, 150u) << name;
    } else {
      EXPECT_EQ(different, 0u) << name;
    }
  }
}

}  // namespace
