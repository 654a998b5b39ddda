// SPDX-License-Identifier: MIT
// The table of results, names of files, and the window that is shown.

#include "quality/results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "quality/noise_table.h"
#include "quality/window.h"

namespace {

TEST(Results, ALineHasAsManyFieldsAsThereAreNames) {
  quality::Result result;
  result.scene = "fan";
  result.method = "whitted";
  result.rate = 0.0625;
  result.metrics.psnr = std::numeric_limits<double>::infinity();
  result.sampler_seconds = 0.125;
  const std::string csv = quality::to_csv(std::vector{result, result});
  ASSERT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  const std::string names = csv.substr(0, csv.find('\n'));
  const std::string line =
      csv.substr(csv.find('\n') + 1, csv.find('\n', names.size() + 1) - names.size() - 1);
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(names.begin(), names.end(), ','));
  EXPECT_TRUE(line.starts_with("fan,whitted,0.0625,")) << line;
  EXPECT_NE(line.find(",inf,"), std::string::npos) << line;
  EXPECT_TRUE(line.ends_with(",0.125")) << line;
}

TEST(Results, TextWithSeparatorsIsQuoted) {
  quality::Result result;
  result.scene = "image:a,\"b\".png";
  const std::string csv = quality::to_csv(std::vector{result});
  EXPECT_NE(csv.find("\n\"image:a,\"\"b\"\".png\","), std::string::npos) << csv;
}

quality::Result noisy_result(const char* scene, const char* method, double rmse, double mean) {
  quality::Result result;
  result.scene = scene;
  result.method = method;
  result.rate = 4;
  result.reference_error = 0.03;
  result.metrics.rmse = rmse;
  result.metrics.relmse = 0.25;
  result.metrics.ssim = 0.5;
  result.metrics.mean_ratio = mean;
  result.metrics.border_step = 1.25;
  result.metrics.negative_share = 0.125;
  return result;
}

TEST(NoiseTable, TakesTheReferencesErrorOutAndSumsUp) {
  // 0.04, 0.08, 0.16 and 0.04 beside an error of 0.03 of the reference.
  const std::vector results{noisy_result("dof", "a", 0.05, 0.9),
                            noisy_result("dof", "b", std::hypot(0.08, 0.03), 1),
                            noisy_result("glossy", "a", std::hypot(0.16, 0.03), 1.05),
                            noisy_result("glossy", "b", 0.05, 1.02)};
  const std::string table = quality::noise_table(results);
  const auto has = [&](const char* scene, const char* method, const char* figures) {
    for (std::size_t begin = 0; begin < table.size();) {
      const std::size_t end = table.find('\n', begin);
      const std::string line = table.substr(begin, end - begin);
      begin = end + 1;
      if (line.find(std::string("| ") + scene + " ") == 0 &&
          line.find(std::string("| ") + method + " ") != std::string::npos) {
        return line.find(figures) != std::string::npos;
      }
    }
    return false;
  };
  EXPECT_TRUE(has("dof", "a", "|  0.0400 |  0.2500 | 0.5000 |  0.900 |  1.250 |   0.1250 |"))
      << table;
  EXPECT_TRUE(has("dof", "b", "|  0.0800 |")) << table;
  // 2 and 1/4: a half and its root.
  EXPECT_TRUE(has("all", "a", "|  1.0000 |  0.2500 | 0.5000 |  0.900 |")) << table;
  EXPECT_TRUE(has("all", "b", "|  0.7071 |  0.2500 | 0.5000 |  1.020 |")) << table;
}

TEST(Results, NamesOfFiles) {
  EXPECT_EQ(quality::file_name("zoneplate-high"), "zoneplate-high");
  EXPECT_EQ(quality::file_name("image:../a b.png"), "image_.._a_b.png");
  EXPECT_EQ(quality::rate_name(1.0 / 16), "1_16");
  EXPECT_EQ(quality::rate_name(1), "1");
  EXPECT_EQ(quality::rate_name(64), "64");
  EXPECT_EQ(quality::rate_name(0.3), "0.3");
}

TEST(Window, IsWhereTheDetailIs) {
  const std::size_t width = 96;
  const std::size_t height = 80;
  std::vector<float> pixels(3 * width * height, 0.5f);
  // A checkerboard from (48, 24) to (80, 56).
  for (std::size_t y = 24; y < 56; ++y) {
    for (std::size_t x = 48; x < 80; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        pixels[3 * (y * width + x) + c] = (x + y) % 2 == 0 ? 0.9f : 0.1f;
      }
    }
  }
  const quality::Window window = quality::busiest_window({width, height, pixels}, 40);
  EXPECT_EQ(window.width, 40u);
  EXPECT_EQ(window.height, 40u);
  EXPECT_LE(window.x, 48u);
  EXPECT_GE(window.x + window.width, 80u);
  EXPECT_LE(window.y, 24u);
  EXPECT_GE(window.y + window.height, 56u);
}

TEST(Window, OfASmallPictureIsAllOfIt) {
  const std::vector<float> pixels(3 * 20 * 30, 0.0f);
  const quality::Window window = quality::busiest_window({20, 30, pixels}, 128);
  EXPECT_EQ(window.x, 0u);
  EXPECT_EQ(window.y, 0u);
  EXPECT_EQ(window.width, 20u);
  EXPECT_EQ(window.height, 30u);
}

}  // namespace
