// SPDX-License-Identifier: MIT
#include "baselines/low_discrepancy.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "baseline_helpers.h"
#include "baselines/supersampling.h"
#include "support/is_net.h"

namespace baselines {
namespace {

/// The least distance between two points of a pattern that repeats, or from one to its own copy.
double least_distance(std::span<const UnitPoint> points) {
  double least = 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = points[i][0] - points[j][0];
      const double dy = points[i][1] - points[j][1];
      least = std::min(least, std::hypot(dx - std::round(dx), dy - std::round(dy)));
    }
  }
  return least;
}

TEST(RotatedGrid, NoTwoPointsShareARowOrAColumn) {
  for (const std::uint64_t count : {1u, 2u, 3u, 4u, 5u, 8u, 16u, 30u, 64u}) {
    const auto points = rotated_grid_points(count);
    ASSERT_EQ(points.size(), count);
    for (std::size_t c = 0; c < 2; ++c) {
      // One in the middle of each of the strips, from which it follows that their mean is 1/2.
      std::set<double> strips;
      for (const UnitPoint& point : points) {
        const double strip = point[c] * static_cast<double>(count) - 0.5;
        EXPECT_NEAR(strip, std::round(strip), 1e-12);
        strips.insert(std::round(strip));
      }
      EXPECT_EQ(strips.size(), count);
      EXPECT_EQ(*strips.begin(), 0);
      EXPECT_EQ(*strips.rbegin(), static_cast<double>(count - 1));
    }
  }
}

TEST(RotatedGrid, NoOtherLatticeIsSpreadMoreEvenly) {
  for (std::uint64_t count = 2; count <= 65; ++count) {
    double best = 0;
    std::uint64_t best_generator = 0;
    for (std::uint64_t g = 1; g < count; ++g) {
      if (std::gcd(g, count) != 1) continue;
      std::vector<UnitPoint> points;
      for (std::uint64_t k = 0; k < count; ++k) {
        points.push_back({static_cast<double>(k) / static_cast<double>(count),
                          static_cast<double>(g * k % count) / static_cast<double>(count)});
      }
      const double distance = least_distance(points);
      if (distance > best + 1e-9) {
        best = distance;
        best_generator = g;
      }
    }
    EXPECT_EQ(lattice_generator(count), best_generator) << count;
    if (count == 4) continue;
    EXPECT_NEAR(least_distance(rotated_grid_points(count)), best, 1e-12) << count;
  }
  // The four of hardware are further apart within the pixel than those of a diagonal, sqrt(2) / 4.
  const auto four = rotated_grid_points(4);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(std::hypot(four[i][0] - four[j][0], four[i][1] - four[j][1]), 0.55);
      for (std::size_t k = 0; k < j; ++k) {
        const double turn = (four[j][0] - four[i][0]) * (four[k][1] - four[i][1]) -
                            (four[j][1] - four[i][1]) * (four[k][0] - four[i][0]);
        EXPECT_GT(std::abs(turn), 0.1) << "three on a line";
      }
    }
  }
  EXPECT_EQ(lattice_generator(5), 2u);
}

TEST(RotatedGrid, IsTheSameInEachPixelAndAveragesIt) {
  for (const std::uint64_t count : {1u, 4u, 7u}) {
    const auto points = rotated_grid_points(count);
    std::vector<std::vector<UnitPoint>> seen(5 * 3);
    std::vector<double> means(seen.size(), 0.0);
    const Radiance radiance = [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
      const std::size_t pixel = static_cast<std::size_t>(y) * 5 + static_cast<std::size_t>(x);
      const float value = static_cast<float>(id % 13);
      std::fill(rgb.begin(), rgb.end(), value);
      seen[pixel].push_back({x - std::floor(x), y - std::floor(y)});
      means[pixel] += static_cast<double>(value) / static_cast<double>(count);
    };
    const Rendering rendering = rotated_grid(radiance, {5, 3, 15 * count, 3});
    for (std::size_t i = 0; i < seen.size(); ++i) {
      ASSERT_EQ(seen[i].size(), count);
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_NEAR(seen[i][k][0], points[k][0], 1e-12);
        EXPECT_NEAR(seen[i][k][1], points[k][1], 1e-12);
      }
      EXPECT_NEAR(rendering.pixels[i * 3], means[i], 1e-5);
    }
  }
}

TEST(RotatedGrid, IsExactOnALinearRamp) {
  const auto ramp = [](double x, double y) { return 2 * x + y; };
  for (const std::uint64_t count : {1u, 3u, 4u, 16u}) {
    const Rendering rendering = rotated_grid(grey(ramp), {9, 7, 9 * 7 * count, 0});
    EXPECT_LT(rms_error(rendering, pixel_means(9, 7, ramp)), 1e-5) << count;
  }
}

TEST(RotatedGrid, HasAsManyLevelsAsSamplesOnANearlyVerticalEdge) {
  // What it is for: a grid of 4 x 4 has but four columns there.
  std::set<float> levels;
  for (double edge = 1.001; edge < 2; edge += 0.01) {
    const auto vertical = [=](double x, double) { return x < edge ? 1.0 : 0.0; };
    levels.insert(rotated_grid(grey(vertical), {3, 1, 3 * 16, 0}).pixels[3]);
  }
  EXPECT_EQ(levels.size(), 17u);
}

TEST(SobolBox, SamplesOfEachPixelAreANetOfItsOwn) {
  std::vector<std::vector<std::array<std::uint32_t, 2>>> seen(4 * 3);
  std::vector<double> means(seen.size(), 0.0);
  const Radiance radiance = [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    const std::size_t pixel = static_cast<std::size_t>(y) * 4 + static_cast<std::size_t>(x);
    const float value = static_cast<float>(id % 13);
    std::fill(rgb.begin(), rgb.end(), value);
    means[pixel] += static_cast<double>(value) / 16;
    seen[pixel].push_back({static_cast<std::uint32_t>((x - std::floor(x)) * 0x1p32),
                           static_cast<std::uint32_t>((y - std::floor(y)) * 0x1p32)});
  };
  const Rendering rendering = sobol_box(radiance, {4, 3, 12 * 16, 3});
  std::set<std::vector<std::array<std::uint32_t, 2>>> distinct(seen.begin(), seen.end());
  EXPECT_EQ(distinct.size(), seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_EQ(seen[i].size(), 16u);
    EXPECT_TRUE(helpers::is_net(seen[i], 4)) << i;
    EXPECT_NEAR(rendering.pixels[i * 3], means[i], 1e-5);
  }
}

TEST(SobolBox, PositionsInAPixelAreUniformOverPixels) {
  // The mean of 4096 uniform deviates is off by 1 / sqrt(12 * 4096); five of them are allowed.
  double x_sum = 0;
  double y_sum = 0;
  const Radiance radiance = [&](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
    std::fill(rgb.begin(), rgb.end(), 0.0f);
    x_sum += x - std::floor(x);
    y_sum += y - std::floor(y);
  };
  (void)sobol_box(radiance, {64, 64, 4096, 3});
  EXPECT_NEAR(x_sum / 4096, 0.5, 5 / std::sqrt(12.0 * 4096));
  EXPECT_NEAR(y_sum / 4096, 0.5, 5 / std::sqrt(12.0 * 4096));
}

TEST(SobolBox, BeatsJitteredSamplesAtAnEdge) {
  // Four evenly spread in every direction: 0.82 of the error was measured.
  const std::vector<double> means = pixel_means(64, 64, slanted_edge);
  const Job job = job_at(64, 64, 4);
  const double jittered =
      rms_error(supersampling(grey(slanted_edge), job, {.jittered = true}), means);
  EXPECT_LT(rms_error(sobol_box(grey(slanted_edge), job), means), jittered);
}

}  // namespace
}  // namespace baselines
