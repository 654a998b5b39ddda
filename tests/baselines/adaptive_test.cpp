// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "baseline_helpers.h"
#include "baselines/multi_stage_filter.h"
#include "baselines/painter_sloan.h"
#include "baselines/two_level.h"
#include "baselines/whitted.h"

namespace baselines {
namespace {

TEST(Whitted, IsExactOnABilinearFunction) {
  const auto bilinear = [](double x, double y) {
    return 0.2 + 0.01 * x + 0.02 * y + 0.001 * x * y;
  };
  for (const double rate : {0.1, 0.3, 1.0, 4.0}) {
    const Rendering rendering = whitted(grey(bilinear), job_at(37, 21, rate));
    EXPECT_LT(rms_error(rendering, pixel_means(37, 21, bilinear)), 1e-5) << rate;
  }
}

TEST(Whitted, NeighboursShareTheirCorners) {
  std::vector<std::pair<double, double>> positions;
  const Radiance radiance = [&](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
    positions.emplace_back(x, y);
    std::fill(rgb.begin(), rgb.end(), static_cast<float>(slanted_edge(x, y)));
  };
  (void)whitted(radiance, job_at(32, 32, 4));
  const std::size_t taken = positions.size();
  std::sort(positions.begin(), positions.end());
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  EXPECT_EQ(positions.size(), taken);
}

TEST(Whitted, CornersOfPixelsWhenTheSharePaysForThem) {
  const Job job{8, 6, 9 * 7, 0};
  const Rendering rendering = whitted(
      grey([](double x, double y) { return std::fmod(x + y, 2.0); }), job, {.base_share = 1});
  // The mean of the four corners, 0 or 1 like a chess board, wherever the pixel is.
  for (std::size_t i = 0; i < 48; ++i) EXPECT_NEAR(rendering.pixels[i * 3], 0.5, 1e-6);
}

TEST(Contrast, IsMichelsons) {
  EXPECT_EQ(contrast({0, 0, 0}, {0, 0, 0}), (Rgb{0, 0, 0}));
  EXPECT_EQ(contrast({0, 1, 2}, {4, 3, 2}), (Rgb{1, 0.5f, 0}));
}

TEST(TwoLevel, HasTwoDensities) {
  // Contrast in a disc only, with more room than the extra samples need.
  const auto disc = [](double x, double y) {
    return std::hypot(x - 32, y - 32) < 8 ? 1 + 0.9 * std::sin(40 * x) : 1.0;
  };
  // Four base samples in each pixel, so that pixels further than one from the disc stay at that.
  const Rendering rendering =
      two_level(grey(disc), job_at(64, 64, 5), {.base_share = 0.8, .most_extra = 100});
  double inside = 0;
  double inside_pixels = 0;
  for (std::size_t y = 0; y < 64; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      const double distance =
          std::hypot(static_cast<double>(x) + 0.5 - 32, static_cast<double>(y) + 0.5 - 32);
      const std::uint32_t count = rendering.samples[y * 64 + x];
      if (distance > 11) {
        ASSERT_EQ(count, 4U);
      } else if (distance < 7) {
        inside += count;
        ++inside_pixels;
      } else {
        ASSERT_GE(count, 4U);
      }
    }
  }
  // 18.7 was measured, with a fifth less allowed.
  EXPECT_GT(inside / inside_pixels, 15);
}

TEST(TwoLevel, LowContrastIsBelowTheThreshold) {
  // Contrast 0.2 in one half, below all thresholds; 0.5 in the other, above those of red and green.
  const auto halves = [](double x, double y) {
    return 1 + (x < 16 ? 0.2 : 0.5) * (std::fmod(x + y, 2.0) < 1 ? 1 : -1);
  };
  const Rendering rendering =
      two_level(grey(halves), job_at(32, 32, 8), {.base_share = 0.5, .most_extra = 16});
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 15; ++x) low += rendering.samples[y * 32 + x];
    for (std::size_t x = 17; x < 32; ++x) high += rendering.samples[y * 32 + x];
  }
  EXPECT_EQ(low, 32U * 15 * 4);
  EXPECT_GE(high, 32U * 15 * 11);
}

TEST(TwoLevel, WithoutContrastTheExtraSamplesAreSpreadEvenly) {
  const Rendering rendering = two_level(constant(1, 1, 1), job_at(32, 32, 8), {.most_extra = 1});
  const auto [least, most] =
      std::minmax_element(rendering.samples.begin(), rendering.samples.end());
  // Two base samples, then at most one extra for each in order of contrast, until all pixels are
  // taken; the rest is shared.
  EXPECT_EQ(*least, 8U);
  EXPECT_EQ(*most, 8U);
}

TEST(MultiStageFilter, DenseAndSparseClumpsWeighEqually) {
  // One half of the pixel has a hundred samples of 1 near one place, the other a single 0.
  std::vector<Sample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({0.3 + i * 1e-4, 0.3, {1, 1, 1}});
  samples.push_back({0.8, 0.8, {0, 0, 0}});
  Rendering rendering = grey_picture(1, 1, 9);
  multi_stage_filter(samples, rendering);
  EXPECT_NEAR(rendering.pixels[0], 0.5, 1e-6);

  Rendering averaged = grey_picture(1, 1, 9);
  const float width = 1;
  weighted_average(samples, PixelFilter::box, {&width, 1}, averaged);
  EXPECT_NEAR(averaged.pixels[0], 100.0 / 101, 1e-5);
}

TEST(MultiStageFilter, AveragesQuartersThenHalvesThenThePixel) {
  // In one quadrant two of its four cells hold 8 and the mean of 2 and 4; in another one holds 1.
  const std::vector<Sample> samples = {
      {0.1, 0.1, {8, 8, 8}}, {0.3, 0.1, {2, 2, 2}}, {0.4, 0.2, {4, 4, 4}}, {0.9, 0.6, {1, 1, 1}}};
  Rendering rendering = grey_picture(1, 1, 0);
  multi_stage_filter(samples, rendering);
  EXPECT_NEAR(rendering.pixels[0], ((8.0 + 3) / 2 + 1) / 2, 1e-6);
}

TEST(MultiStageFilter, EmptyPixelsTakeTheMeanOfTheNearest) {
  const std::vector<Sample> samples = {{0.5, 0.5, {2, 2, 2}}, {2.5, 0.5, {4, 4, 4}}};
  Rendering rendering = grey_picture(6, 1, 0);
  multi_stage_filter(samples, rendering);
  // Windows of 3, 3, 3 and 5 pixels; the last pixel needs 9, which hold both samples but not (0).
  const float expected[] = {2, 3, 4, 4, 4, 4};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(rendering.pixels[i * 3], expected[i]) << i;
}

struct Cells {
  std::vector<Rectangle> areas;
  Rendering rendering;
};

Cells painter_sloan_cells(const Radiance& radiance, const Job& job) {
  Cells cells;
  cells.rendering = painter_sloan(
      radiance, job, {}, [&](const Rectangle& cell, const Rgb&) { cells.areas.push_back(cell); });
  return cells;
}

TEST(PainterSloan, CellsTileTheImageAndHoldOneSampleEach) {
  for (const double rate : {0.1, 1.0, 3.7}) {
    const Job job = job_at(37, 21, rate);
    std::vector<Sample> samples;
    const Radiance radiance = [&](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
      const auto value = static_cast<float>(slanted_edge(x, y));
      samples.push_back({x, y, {value, value, value}});
      std::fill(rgb.begin(), rgb.end(), value);
    };
    const Cells cells = painter_sloan_cells(radiance, job);
    ASSERT_EQ(cells.areas.size(), job.samples);
    double area = 0;
    for (const Rectangle& cell : cells.areas) {
      area += cell.area();
      EXPECT_EQ(std::count_if(samples.begin(), samples.end(),
                              [&](const Sample& sample) {
                                // Positions are stored as floats.
                                const auto x = static_cast<double>(static_cast<float>(sample.x));
                                const auto y = static_cast<double>(static_cast<float>(sample.y));
                                return x >= cell.left && x < cell.right && y >= cell.top &&
                                       y < cell.bottom;
                              }),
                1);
    }
    EXPECT_NEAR(area, 37 * 21, 1e-6);
  }
}

TEST(PainterSloan, PixelsAreExactMeansOfTheCells) {
  const Job job = job_at(13, 9, 2.2);
  std::vector<std::pair<Rectangle, float>> cells;
  const auto waves = [](double x, double y) { return 1 + std::sin(x) * std::cos(2 * y); };
  const Rendering rendering = painter_sloan(
      grey(waves), job, {},
      [&](const Rectangle& cell, const Rgb& radiance) { cells.emplace_back(cell, radiance[0]); });
  for (std::size_t i = 0; i < 13 * 9; ++i) {
    const auto x = static_cast<double>(i % 13);
    const auto y = static_cast<double>(i / 13);
    double sum = 0;
    for (const auto& [cell, value] : cells) {
      const double width = std::min(cell.right, x + 1) - std::max(cell.left, x);
      const double height = std::min(cell.bottom, y + 1) - std::max(cell.top, y);
      if (width > 0 && height > 0) sum += width * height * static_cast<double>(value);
    }
    ASSERT_NEAR(rendering.pixels[i * 3], sum, 1e-5) << i;
  }
}

TEST(PainterSloan, CoversAFlatImageEvenly) {
  const Cells cells = painter_sloan_cells(constant(1, 1, 1), {32, 32, 1000, 1});
  double least = 1e9;
  double most = 0;
  for (const Rectangle& cell : cells.areas) {
    least = std::min(least, cell.area());
    most = std::max(most, cell.area());
  }
  // Halving 1024 pixels 1000 times cannot do better than sizes a factor of 2 apart.
  EXPECT_NEAR(most / least, 2, 1e-6);
}

}  // namespace
}  // namespace baselines
