// SPDX-License-Identifier: MIT
#include "mpi/window_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace farm {
namespace {

TEST(WindowPlan, TilesThePictureBetweenBlocks) {
  std::mt19937 random(1);
  const auto below = [&](unsigned end) { return std::size_t{random() % end + 1}; };
  for (int round = 0; round < 100; ++round) {
    const std::size_t width = below(200), height = below(200);
    std::vector<int> covered(width * height);
    for (const auto& window : cut_windows(width, height, below(30), below(30))) {
      EXPECT_EQ(window.x % 8, 0u);
      EXPECT_EQ(window.y % 8, 0u);
      ASSERT_GT(window.width * window.height, 0u);
      for (std::size_t y = window.y; y < window.y + window.height; ++y) {
        for (std::size_t x = window.x; x < window.x + window.width; ++x) {
          ++covered.at(y * width + x);
        }
      }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1),
              static_cast<std::ptrdiff_t>(covered.size()));
  }
}

TEST(WindowPlan, HasWindowsOfAboutTheSameSize) {
  const auto windows = cut_windows(1920, 1080, 4, 3);
  ASSERT_EQ(windows.size(), 12u);
  for (const auto& window : windows) {
    EXPECT_EQ(window.width, 480u);
    EXPECT_NEAR(static_cast<double>(window.height), 360, 8);
  }
}

TEST(WindowPlan, SharesOutByTheCoarsePicture) {
  constexpr std::size_t width = 250, height = 190, step = 4;
  freqsynth::FrequencyImage coarse((width + step - 1) / step, (height + step - 1) / step, 1);
  std::mt19937 random(2);
  for (std::size_t y = 0; y < coarse.blocks_y(); ++y) {
    for (std::size_t x = 0; x < coarse.blocks_x(); ++x)
      coarse.samples(x, y) = static_cast<std::uint32_t>(random() % 100);
  }
  const auto windows = cut_windows(width, height, 3, 2);
  constexpr std::uint64_t samples = 1000000;
  const auto tasks = share_out(windows, coarse, step, samples);
  ASSERT_EQ(tasks.size(), windows.size());

  // Point by point: what the coarse picture has there, over the area of its block.
  std::vector<double> weights;
  for (const auto& window : windows) {
    double sum = 0;
    const double left = static_cast<double>(window.x) - 8;
    const double top = static_cast<double>(window.y) - 8;
    for (double y = 0.125; y < static_cast<double>(coarse.height()); y += 0.25) {
      for (double x = 0.125; x < static_cast<double>(coarse.width()); x += 0.25) {
        const double u = x * step - left, v = y * step - top;
        if (u < 0 || v < 0 || u > static_cast<double>(window.width) + 16 ||
            v > static_cast<double>(window.height) + 16) {
          continue;
        }
        const auto bx = static_cast<std::size_t>(x / 8), by = static_cast<std::size_t>(y / 8);
        const double area = static_cast<double>(std::min<std::size_t>(8, coarse.width() - 8 * bx) *
                                                std::min<std::size_t>(8, coarse.height() - 8 * by));
        sum += coarse.samples(bx, by) / area;
      }
    }
    weights.push_back(sum);
  }
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(tasks[i].samples), samples * weights[i] / all, 1);
  }
}

TEST(WindowPlan, LeavesNoBlockWithoutASample) {
  const freqsynth::FrequencyImage nothing(16, 16, 1);
  for (const auto& task : share_out(cut_windows(128, 128, 2, 2), nothing, 8, 10)) {
    EXPECT_GE(task.samples, 8u * 8u);
  }
}

TEST(WindowPlan, LooksCoarselyButNotTooMuch) {
  EXPECT_EQ(coarse_step(1920, 1080), 8u);
  EXPECT_EQ(coarse_step(200, 100), 4u);
  EXPECT_EQ(coarse_step(10, 10), 2u);
  EXPECT_EQ(coarse_step(65536, 65536), 64u);
}

}  // namespace
}  // namespace farm
