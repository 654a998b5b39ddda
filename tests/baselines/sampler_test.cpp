// SPDX-License-Identifier: MIT
#include "baselines/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <vector>

#include "baseline_helpers.h"

namespace baselines {
namespace {

/// Checks that the areas are equal, inside `area`, and that no two cover the same point: each of a
/// lattice of points, none on a border, lies in exactly one.
void expect_tiling(const std::vector<Rectangle>& tiles, const Rectangle& area) {
  for (const Rectangle& tile : tiles) {
    EXPECT_NEAR(tile.area(), area.area() / static_cast<double>(tiles.size()), 1e-9 * area.area());
    EXPECT_GE(tile.left, area.left - 1e-9);
    EXPECT_GE(tile.top, area.top - 1e-9);
    EXPECT_LE(tile.right, area.right + 1e-9);
    EXPECT_LE(tile.bottom, area.bottom + 1e-9);
  }
  constexpr int points = 23;
  for (int j = 0; j < points; ++j) {
    for (int i = 0; i < points; ++i) {
      const double x = area.left + area.width() * (i + 0.5137) / points;
      const double y = area.top + area.height() * (j + 0.4871) / points;
      EXPECT_EQ(std::count_if(tiles.begin(), tiles.end(),
                              [&](const Rectangle& tile) {
                                return x >= tile.left && x < tile.right && y >= tile.top &&
                                       y < tile.bottom;
                              }),
                1)
          << x << ' ' << y;
    }
  }
}

TEST(EqualAreas, TileTheArea) {
  for (const Rectangle area : {Rectangle{0, 0, 37, 21}, Rectangle{2.5, 1, 3, 9},
                               Rectangle{0, 0, 1000, 1}, Rectangle{0, 0, 1, 1}}) {
    for (std::uint64_t count = 1; count < 40; ++count) {
      std::vector<Rectangle> tiles;
      for_each_equal_area(area, count, [&](const Rectangle& tile) { tiles.push_back(tile); });
      ASSERT_EQ(tiles.size(), count);
      expect_tiling(tiles, area);
    }
  }
}

TEST(EqualAreas, AreNearlySquare) {
  for (std::uint64_t count = 16; count < 200; ++count) {
    for_each_equal_area({0, 0, 16, 9}, count, [&](const Rectangle& tile) {
      EXPECT_LT(tile.width(), 2 * tile.height()) << count;
      EXPECT_LT(tile.height(), 2 * tile.width()) << count;
    });
  }
}

TEST(Strata, AWholeNumberPerPixelStaysInThePixel) {
  for (const std::uint64_t per_pixel : {1u, 2u, 3u, 4u, 6u, 7u, 12u, 16u}) {
    const Job job{5, 3, 15 * per_pixel, 0};
    std::vector<std::vector<Rectangle>> in_pixel(15);
    for_each_stratum(job, [&](const Rectangle& tile) {
      in_pixel[pixel_at((tile.left + tile.right) / 2, (tile.top + tile.bottom) / 2, 5, 3)]
          .push_back(tile);
    });
    for (std::size_t i = 0; i < 15; ++i) {
      const auto x = static_cast<double>(i % 5);
      const auto y = static_cast<double>(i / 5);
      ASSERT_EQ(in_pixel[i].size(), per_pixel);
      expect_tiling(in_pixel[i], {x, y, x + 1, y + 1});
    }
  }
}

TEST(Strata, SidesAreTheTwoNearestFactors) {
  const std::map<std::uint64_t, double> columns = {{1, 1}, {2, 2},  {4, 2},  {6, 3},
                                                   {7, 7}, {12, 4}, {16, 4}, {24, 6}};
  for (const auto& [per_pixel, expected] : columns) {
    for_each_stratum({1, 1, per_pixel, 0}, [&, expected = expected](const Rectangle& tile) {
      EXPECT_NEAR(1 / tile.width(), expected, 1e-9);
    });
  }
}

TEST(Strata, AnyOtherNumberTilesTheImage) {
  for (const std::uint64_t samples : {1u, 7u, 100u, 776u, 778u, 1000u}) {
    const Job job{37, 21, samples, 0};
    std::vector<Rectangle> tiles;
    for_each_stratum(job, [&](const Rectangle& tile) { tiles.push_back(tile); });
    ASSERT_EQ(tiles.size(), samples);
    expect_tiling(tiles, {0, 0, 37, 21});
  }
}

TEST(PixelAt, TheFarBordersBelongToTheLastPixels) {
  EXPECT_EQ(pixel_at(0, 0, 4, 3), 0U);
  EXPECT_EQ(pixel_at(1, 0, 4, 3), 1U);
  EXPECT_EQ(pixel_at(0.999, 1, 4, 3), 4U);
  EXPECT_EQ(pixel_at(4, 3, 4, 3), 11U);
}

TEST(Sampler, TakesNoMoreThanAllowed) {
  const Radiance radiance = constant(1, 2, 3);
  const Job job{2, 2, 2, 0};
  Sampler sampler(radiance, job);
  EXPECT_EQ(sampler.take(0.5, 0.5).rgb, (Rgb{1, 2, 3}));
  sampler.take(1.5, 1.5);
  EXPECT_EQ(sampler.left(), 0U);
  EXPECT_THROW(sampler.take(0, 0), std::logic_error);
  EXPECT_EQ(sampler.rendering().samples, (std::vector<std::uint32_t>{1, 0, 0, 1}));
}

TEST(Sampler, SamplesWithFeaturesAreNamedAndCountedAsTheOthers) {
  std::vector<std::uint64_t> ids, featured_ids;
  const Radiance radiance = [&](double, double, std::uint64_t id, std::span<float, 3> rgb) {
    ids.push_back(id);
    std::fill(rgb.begin(), rgb.end(), 0.5f);
  };
  Job job{3, 2, 3, 9};
  std::array<float, 10> values{};
  const auto take_all = [&] {
    Sampler sampler(radiance, job);
    for (const double x : {0.5, 2.5, 2.25}) sampler.take_with_features(x, 1.5, values);
    EXPECT_EQ(sampler.rendering().samples, (std::vector<std::uint32_t>{0, 0, 0, 1, 0, 2}));
    EXPECT_THROW(sampler.take_with_features(1, 1, values), std::logic_error);
  };
  take_all();
  EXPECT_EQ(values, (std::array<float, 10>{0.5f, 0.5f, 0.5f})) << "no features are known";
  job.features = 7;
  job.radiance_and_features = [&](double, double, std::uint64_t id, std::span<float> all) {
    featured_ids.push_back(id);
    std::fill(all.begin(), all.end(), 0.25f);
  };
  take_all();
  EXPECT_EQ(values.back(), 0.25f);
  EXPECT_EQ(ids, featured_ids);
}

TEST(Random, IsUniformAndTheSameEverywhere) {
  // The standard fixes the 10000th number of the generator with its default seed.
  std::mt19937_64 generator(5489);
  generator.discard(9999);
  const double expected = static_cast<double>(generator() >> 11) / 9007199254740992.0;
  Random random(5489);
  double sum = 0;
  double last = 0;
  for (int i = 0; i < 10000; ++i) {
    last = random.uniform();
    ASSERT_GE(last, 0);
    ASSERT_LT(last, 1);
    sum += last;
  }
  EXPECT_EQ(last, expected);
  EXPECT_NEAR(expected, 9981545732273789042.0 / 18446744073709551616.0, 1e-15);
  // Five deviations of a mean of 10000.
  EXPECT_NEAR(sum / 10000, 0.5, 5 * std::sqrt(1.0 / 12) / 100);
}

}  // namespace
}  // namespace baselines
