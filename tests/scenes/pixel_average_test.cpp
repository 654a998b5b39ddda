// SPDX-License-Identifier: MIT
// The averages over pixels that scenes know exactly, and the areas that they are made of.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <tuple>

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
  /// side^2 cells, and is wrong by about half of each, at random. The least pixels of the fan and
  /// the star have many edges. A wave is wrong by its second derivatives / (24 side^2).
  int side;
  double tolerance;
};

TEST(PixelAverage, AgreesWithSupersampling) {
  // The gradient in few pixels, so that their means differ from the values at their centres.
  for (const auto& [name, width, height, side, tolerance] :
       {AverageCase{"edge", 40, 24, 100, 0.01}, AverageCase{"corner", 40, 24, 100, 0.01},
        AverageCase{"dot", 40, 24, 100, 0.01 * 2.82}, AverageCase{"dot", 5, 3, 100, 0.01 * 2.82},
        AverageCase{"gradient", 5, 4, 100, 2e-5}, AverageCase{"fan", 24, 16, 300, 0.01},
        AverageCase{"fan", 9, 40, 300, 0.01}, AverageCase{"star", 24, 16, 300, 0.01},
        AverageCase{"star", 7, 12, 300, 0.01}, AverageCase{"zoneplate", 24, 16, 100, 3e-5},
        AverageCase{"zoneplate-high", 16, 24, 100, 8e-5}}) {
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
  for (const std::string_view name : {"chess", "checker", "sun", "dof"}) {
    Color rgb{7, 8, 9};
    EXPECT_FALSE(make(name, 32, 32)->pixel_average(3, 4, rgb)) << name;
    EXPECT_EQ(rgb, (Color{7, 8, 9})) << name;
  }
}

TEST(PixelAverage, IsTheMeanOfTheAveragesOfItsParts) {
  // The same picture in pixels of half the size: other edges are clipped, by other pixels. A zone
  // plate has half the frequency per pixel there; at 5 cycles per pixel and more than one panel.
  for (const std::string_view name : {"fan", "star", "zoneplate"}) {
    for (const auto& [width, height, frequency] :
         {std::tuple{32, 24, 0.4}, {19, 37, 0.8}, {8, 8, 5.0}, {1, 1, 0.4}}) {
      const auto whole = scenes::make_scene({.name = std::string(name),
                                             .width = width,
                                             .height = height,
                                             .zone_frequency = frequency});
      const auto parts = scenes::make_scene({.name = std::string(name),
                                             .width = 3 * width,
                                             .height = 3 * height,
                                             .zone_frequency = frequency / 3});
      for (long j = 0; j < height; ++j) {
        for (long i = 0; i < width; ++i) {
          Color rgb{};
          ASSERT_TRUE(whole->pixel_average(i, j, rgb));
          double mean = 0;
          for (long k = 0; k < 9; ++k) {
            Color part{};
            ASSERT_TRUE(parts->pixel_average(3 * i + k % 3, 3 * j + k / 3, part));
            mean += double{part[0]} / 9;
          }
          // Rounding to float, of the whole and of the parts.
          EXPECT_NEAR(rgb[0], mean, 1e-7) << name << ' ' << i << ", " << j;
          EXPECT_EQ(rgb, (Color{rgb[0], rgb[0], rgb[0]}));
        }
      }
    }
  }
}

float value_of(const scenes::Scene& scene, long i, long j) {
  Color rgb{};
  EXPECT_TRUE(scene.pixel_average(i, j, rgb));
  return rgb[0];
}

TEST(PixelAverage, HasTheSymmetriesOfTheScene) {
  const auto fan = make("fan", 101, 77);
  const auto plate = make("zoneplate-high", 101, 101);
  for (long j = 0; j < 77; ++j) {
    for (long i = 0; i < 101; ++i) {
      EXPECT_NEAR(value_of(*fan, i, j), value_of(*fan, 100 - i, j), 1e-7);
      EXPECT_EQ(value_of(*plate, i, j), value_of(*plate, j, i));
    }
  }
  // The star's centre is a corner of pixels at this size, (507, 494). Its spokes are odd: half a
  // turn, and a reflection too, exchange black and white.
  const auto star = make("star", 1000, 1000);
  for (long j = 480; j < 494; ++j) {
    for (long i = 490; i < 540; ++i) {
      EXPECT_NEAR(value_of(*star, i, j) + value_of(*star, 1013 - i, 987 - j), 1, 1e-7);
      EXPECT_NEAR(value_of(*star, i, j) + value_of(*star, i, 987 - j), 1, 1e-7);
    }
  }
}

TEST(PixelAverage, OfWavesFarTooFastIsLeftToSamples) {
  const auto plate =
      scenes::make_scene({.name = "zoneplate", .width = 16, .height = 16, .zone_frequency = 1e300});
  Color rgb{7, 8, 9};
  EXPECT_FALSE(plate->pixel_average(15, 15, rgb));
  EXPECT_EQ(rgb, (Color{7, 8, 9}));
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
  // Half the disc; 16 of 31 stripes of a trapezoid.
  EXPECT_NEAR(total(*make("star", 64, 80), 64, 80)[0], 64 * 80 - pi * std::pow(0.47 * 64, 2) / 2,
              1e-3);
  EXPECT_NEAR(total(*make("fan", 90, 70), 90, 70)[0],
              90 * 70 * (1 - 0.88 * (0.86 + 0.06) / 2 * 16 / 31), 1e-3);
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

TEST(Area, LeftOfALine) {
  EXPECT_EQ(scenes::left_area(0.25, 0.25), 0.25);
  EXPECT_EQ(scenes::left_area(0, 1), 0.5);
  EXPECT_EQ(scenes::left_area(-1, 1), 0.25);
  EXPECT_EQ(scenes::left_area(-3, -1e-9), 0);
  EXPECT_EQ(scenes::left_area(3, 1), 1);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2, 3);
  for (int i = 0; i < 1000; ++i) {
    const double top = uniform(random), bottom = uniform(random);
    const double area = scenes::left_area(top, bottom);
    EXPECT_NEAR(area, scenes::left_area(bottom, top), 1e-15);
    EXPECT_NEAR(area + scenes::left_area(1 - top, 1 - bottom), 1, 1e-15);
    // x + (top - bottom) y < top, where that formula keeps its digits.
    if (std::abs(top - bottom) < 1e-3) continue;
    EXPECT_NEAR(area, scenes::half_plane_area(1, top - bottom, top), 1e-11);
  }
}

TEST(Area, OfSectorsAddsUp) {
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(scenes::sector_area(0, 0, 9, 0, 0.125), 0.5, 1e-14);
  EXPECT_NEAR(scenes::sector_area(0, -1, 9, 0, 0.125), 0, 1e-14);
  EXPECT_NEAR(scenes::sector_area(-0.4, -0.7, 0.2, 0.3, 0.45), 0.15 * pi * 0.04, 1e-14);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 200; ++i) {
    const double x = uniform(random), y = uniform(random), radius = 5 * uniform(random);
    const double begin = uniform(random), end = begin + 0.49 * uniform(random);
    double sum = 0;
    for (int j = -7; j < 7; ++j) {
      for (int k = -7; k < 7; ++k) {
        const double part = scenes::sector_area(j + x, k + y, radius, begin, end);
        sum += part;
        // Four sectors make the disc.
        double rest = 0;
        for (int third = 0; third < 3; ++third) {
          const double step = (begin + 1 - end) / 3;
          rest += scenes::sector_area(j + x, k + y, radius, end + third * step,
                                      end + (third + 1) * step);
        }
        EXPECT_NEAR(part + rest, scenes::disc_area(j + x, k + y, radius), 1e-13);
      }
    }
    EXPECT_NEAR(sum, (end - begin) * pi * radius * radius, 1e-12);
  }
}

}  // namespace
