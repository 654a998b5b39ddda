// SPDX-License-Identifier: MIT
#include "live/attention.h"

#include <gtest/gtest.h>

#include <cmath>

namespace live {
namespace {

TEST(Attention, IsOneWithoutAny) {
  EXPECT_EQ(importance_of({}, 20, 9), std::vector<float>(3 * 2, 1.0f));
}

TEST(Attention, FrameTakesTheBlocksThatItHasPixelsOf) {
  const Frame frame{7.5, 8, 16, 24.1};
  const std::vector<float> importance = importance_of({frame, {}}, 40, 40);
  for (std::size_t block = 0; block < 25; ++block) {
    // Slowly: whether any of 80 x 80 points of the block is inside.
    bool inside = false;
    for (int i = 0; i < 80; ++i) {
      for (int j = 0; j < 80; ++j) {
        const double x = static_cast<double>(block % 5 * 8) + (i + 0.5) / 10;
        const double y = static_cast<double>(block / 5 * 8) + (j + 0.5) / 10;
        inside = inside || (x > frame.left && x < frame.right && y > frame.top && y < frame.bottom);
      }
    }
    EXPECT_EQ(importance[block], inside ? attended_weight : 1) << block;
  }
}

TEST(Attention, PointerTakesADisc) {
  const std::vector<float> importance = importance_of({{}, Point{50, 60}}, 120, 120);
  for (std::size_t block = 0; block < 225; ++block) {
    const double x = static_cast<double>(block % 15) * 8 + 4 - 50;
    const double y = static_cast<double>(block / 15) * 8 + 4 - 60;
    EXPECT_EQ(importance[block], std::sqrt(x * x + y * y) <= 32 ? attended_weight : 1) << block;
  }
}

}  // namespace
}  // namespace live
