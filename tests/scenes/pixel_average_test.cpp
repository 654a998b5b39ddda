// The averages over pixels that scenes know exactly, and the areas that they are made of.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string_view>

#include "scene_helpers.h"
#include "scenes/area.h"
#include "scenes/scene.h"

namespace {

using scene_helpers::Color;
using scene_helpers::make;
using scene_helpers::radiance;

/// The mean over the pixel, from a grid of points.
std::array<double, 3> supersampled(const scenes::Scene& scene, long i, long j, int side) {
  std::array<double, 3> mean{};
  for (int k = 0; k < side * side; ++k) {
    const double x = static_cast<double>(i) + (k % side + 0.5) / side;
    const double y = static_cast<double>(j) + (k / side + 0.5) / side;
    const Color rgb = radiance(scene, x, y);
    for (std::size_t c = 0; c < 3; ++c) mean[c] += double{rgb[c]} / (side * side);
  }
  return mean;
}

struct AverageCase {
  std::string_view name;
  int width, height;
  /// Of the grid of points: a straight edge or a small disc passes through less than 2 side of its
  /// side^2 cells, and is wrong by about half of each, at random.
  int side;
  double tolerance;
};

TEST(PixelAverage, AgreesWithSupersampling) {
  // The gradient in few pixels, so that their means differ from the values at their centres.
  for (const auto& [name, width, height, side, tolerance] :
       {AverageCase{"edge", 40, 24, 100, 0.01}, AverageCase{"corner", 40, 24, 100, 0.01},
        AverageCase{"dot", 40, 24, 100, 0.01 * 2.82}, AverageCase{"dot", 5, 3, 100, 0.01 * 2.82},
        AverageCase{"gradient", 5, 4, 100, 2e-5}}) {
    const auto scene = make(name, width, height);
    std::size_t partial = 0;
    for (long j = 0; j < height; ++j) {
      for (long i = 0; i < width; ++i) {
        Color exact{};
        ASSERT_TRUE(scene->pixel_average(i, j, exact)) << name;
        const auto brute = supersampled(*scene, i, j, side);
        const Color center =
            radiance(*scene, static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(exact[c], brute[c], tolerance) << name << ' ' << i << ", " << j;
          if (std::abs(exact[c] - center[c]) > 10 * tolerance) ++partial;
        }
      }
    }
    EXPECT_GT(partial, 0u) << name << ": one sample would have done";
  }
}

TEST(PixelAverage, IsLeftAloneWhereItIsUnknown) {
  for (const std::string_view name : {"fan", "chess", "star", "checker", "dof"}) {
    Color rgb{7, 8, 9};
    EXPECT_FALSE(make(name, 32, 32)->pixel_average(3, 4, rgb)) << name;
    EXPECT_EQ(rgb, (Color{7, 8, 9})) << name;
  }
}

std::array<double, 3> total(const scenes::Scene& scene, int width, int height) {
  std::array<double, 3> sum{};
  for (long j = 0; j < height; ++j) {
    for (long i = 0; i < width; ++i) {
      Color rgb{};
      EXPECT_TRUE(scene.pixel_average(i, j, rgb));
      for (std::size_t c = 0; c < 3; ++c) sum[c] += double{rgb[c]};
    }
  }
  return sum;
}

TEST(PixelAverage, AddsUpToTheKnownTotal) {
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(total(*make("edge", 100, 70), 100, 70)[0], 0.57 * 100 * 70, 1e-3);
  const auto corner = total(*make("corner", 90, 50), 90, 50);
  for (std::size_t c = 0; c < 3; ++c) {
    const double light = radiance(*make("corner", 90, 50), 89.9, 49.9)[c];
    EXPECT_NEAR(corner[c], light * pi * 36 / 4, 1e-3);
  }
  const double dots = 49 * pi * 0.09 * (3 - 0.18);
  EXPECT_NEAR(total(*make("dot", 64, 100), 64, 100)[1], 0.18 * 64 * 100 + dots, 1e-3);
}

TEST(Area, OfHalfPlanes) {
  EXPECT_NEAR(scenes::half_plane_area(1, 1, 1), 0.5, 1e-15);
  EXPECT_NEAR(scenes::half_plane_area(1, 1, 0.5), 0.125, 1e-15);
  EXPECT_NEAR(scenes::half_plane_area(2, 1, 1), 0.25, 1e-15);
  EXPECT_NEAR(scenes::half_plane_area(-2, 1, 0), 0.75, 1e-15);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double a = uniform(random), b = uniform(random), c = 2 * uniform(random);
    if (std::abs(a * b) < 1e-3) continue;
    const double area = scenes::half_plane_area(a, b, c);
    // The other side, mirror images, and the same square cut in its diagonal's terms.
    EXPECT_NEAR(area + scenes::half_plane_area(-a, -b, -c), 1, 1e-12);
    EXPECT_NEAR(area, scenes::half_plane_area(b, a, c), 1e-12);
    EXPECT_NEAR(area, scenes::half_plane_area(-a, b, c - a), 1e-12);
  }
}

TEST(Area, OfDiscsAddsUp) {
  EXPECT_EQ(scenes::disc_area(-0.5, -0.5, 1), 1);
  EXPECT_EQ(scenes::disc_area(1, 1, 1.4), 0);
  EXPECT_NEAR(scenes::disc_area(0, 0, 1), std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(scenes::disc_area(-0.2, -0.7, 0.1), std::numbers::pi * 0.01, 1e-15);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 200; ++i) {
    const double x = uniform(random), y = uniform(random), radius = 5 * uniform(random);
    double sum = 0;
    for (int j = -7; j < 7; ++j) {
      for (int k = -7; k < 7; ++k) sum += scenes::disc_area(j + x, k + y, radius);
    }
    EXPECT_NEAR(sum, std::numbers::pi * radius * radius, 1e-12);
  }
}

}  // namespace
