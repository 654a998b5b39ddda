// SPDX-License-Identifier: MIT
#include "freqsynth/image/own_means.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using Pixels = std::array<float, max_terms>;

/// The definition, literally.
Pixels literal(const OwnMeans& means, const Pixels& pixels, float range, float ringing) {
  Pixels held = pixels;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const auto at = [&](int dx, int dy) {
        return means.at(static_cast<std::size_t>(x + 1 + dx), static_cast<std::size_t>(y + 1 + dy));
      };
      const float own = at(0, 0);
      if (own == OwnMeans::unknown) continue;
      float low = own, high = own;
      int alike = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if ((dx == 0 && dy == 0) || !(std::abs(at(dx, dy) - own) <= 7e-4f * range)) continue;
          ++alike;
          low = std::min(low, at(dx, dy));
          high = std::max(high, at(dx, dy));
        }
      }
      float& pixel = held[static_cast<std::size_t>(8 * y + x)];
      const float nearest = pixel < low ? low : pixel > high ? high : pixel;
      const bool rings = alike >= 2 && std::abs(pixel - nearest) <= ringing * range;
      if (alike == 8 || rings) pixel = nearest;
    }
  }
  return held;
}

TEST(OwnMeans, HoldIsItsDefinition) {
  oracle::Random random(7);
  std::size_t changed = 0, kept = 0;
  for (int round = 0; round < 400; ++round) {
    OwnMeans means;
    // Flat parts with a little texture, some without samples.
    const double edge = random.uniform(-4, 12), slope = random.uniform(-1, 1);
    const double texture = random.below(2) == 0 ? 0 : random.uniform(0, 2e-3);
    for (std::size_t y = 0; y < OwnMeans::side; ++y) {
      for (std::size_t x = 0; x < OwnMeans::side; ++x) {
        if (random.below(8) == 0 && round % 2 == 0) continue;
        const bool bright = static_cast<double>(x) + slope * static_cast<double>(y) > edge;
        means.at(x, y) = static_cast<float>((bright ? 3 : 1) + texture * random.uniform(-1, 1));
      }
    }
    Pixels pixels;
    for (float& pixel : pixels) pixel = static_cast<float>(random.uniform(0.9, 3.1));
    const Pixels expected = literal(means, pixels, 2, 0.02f);
    Pixels held = pixels;
    means.hold(held, 2, 0.02f);
    ASSERT_EQ(held, expected);
    for (std::size_t i = 0; i < max_terms; ++i) ++(held[i] == pixels[i] ? kept : changed);
  }
  EXPECT_GT(changed, 5000u);
  EXPECT_GT(kept, 5000u);
}

TEST(OwnMeans, AreThoseOfTheBlockAndOfThePixelsThatTouchIt) {
  std::array<Pixels, 9> blocks;
  for (std::size_t k = 0; k < 9; ++k) {
    for (std::size_t i = 0; i < max_terms; ++i) blocks[k][i] = static_cast<float>(100 * k + i);
  }
  for (std::size_t missing = 0; missing < 9; ++missing) {
    BlocksMeans pointers;
    for (std::size_t k = 0; k < 9; ++k) pointers[k] = k == missing ? nullptr : blocks[k].data();
    const OwnMeans means(pointers);
    for (std::size_t row = 0; row < OwnMeans::side; ++row) {
      for (std::size_t column = 0; column < OwnMeans::side; ++column) {
        // Of a picture of 24 x 24 pixels, whose block in the middle it is.
        const std::size_t x = 7 + column, y = 7 + row, k = y / 8 * 3 + x / 8;
        const float expected = k == missing ? OwnMeans::unknown : blocks[k][y % 8 * 8 + x % 8];
        ASSERT_EQ(means.at(column, row), expected) << column << ", " << row;
      }
    }
  }
}

TEST(OwnMeans, NothingIsHeldWhereNothingIsKnown) {
  Pixels pixels, before;
  for (std::size_t i = 0; i < max_terms; ++i) pixels[i] = static_cast<float>(i) - 20;
  before = pixels;
  OwnMeans().hold(pixels, 64, 0.02f);
  EXPECT_EQ(pixels, before);
}

}  // namespace
}  // namespace freqsynth
