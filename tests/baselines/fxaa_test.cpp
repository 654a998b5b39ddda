// SPDX-License-Identifier: MIT
#include "baselines/fxaa.h"

#include <gtest/gtest.h>

#include <random>

#include "baseline_helpers.h"
#include "baselines/supersampling.h"

namespace baselines {
namespace {

template <class Function>
Rendering picture_of(std::size_t width, std::size_t height, Function function) {
  Rendering picture = grey_picture(width, height, 0);
  for (std::size_t i = 0; i < width * height; ++i) {
    const float value = function(i % width, i / width);
    std::fill_n(&picture.pixels[i * 3], 3, value);
  }
  return picture;
}

TEST(Fxaa, FollowsAnEdgeToItsEnds) {
  // White above a black stair: four rows, five from the 8th column on, six from the 14th.
  const Rendering stair = picture_of(24, 12, [](std::size_t x, std::size_t y) {
    return y < (x < 8 ? 4u : x < 14 ? 5u : 6u) ? 1.0f : 0.0f;
  });
  const Rendering filtered = fxaa_filtered(stair);
  const auto at = [&](std::size_t x, std::size_t y) {
    return static_cast<double>(filtered.pixels[(y * 24 + x) * 3]);
  };
  // Black below the middle step, whose ends are seven apart: covered towards the higher step on the
  // right, by 1/2 - distance / 7; the white above it likewise on the left.
  EXPECT_NEAR(at(13, 5), 0.5 - 1.0 / 7, 1e-6);
  EXPECT_NEAR(at(12, 5), 0.5 - 2.0 / 7, 1e-6);
  EXPECT_NEAR(at(8, 4), 0.5 + 1.0 / 7, 1e-6);
  EXPECT_NEAR(at(9, 4), 0.5 + 2.0 / 7, 1e-6);
  // On the other side of the nearer end nothing but the smoothing of a straight edge: 4/12 of the
  // neighbours' weight, smoothed twice.
  const double smooth = (1.0 / 9) * (3 - 2.0 / 3);
  EXPECT_NEAR(at(9, 5), 0.75 * smooth * smooth, 1e-6);
  // Far from the edge nothing at all.
  for (std::size_t x = 0; x < 24; ++x) {
    EXPECT_EQ(at(x, 2), 1);
    EXPECT_EQ(at(x, 8), 0);
  }
}

TEST(Fxaa, ALonePixelIsSmoothed) {
  const Rendering dot =
      picture_of(9, 9, [](std::size_t x, std::size_t y) { return x == 4 && y == 4 ? 1.0f : 0.0f; });
  // All around it differ by the whole range: three quarters of a neighbour.
  EXPECT_NEAR(fxaa_filtered(dot).pixels[(4 * 9 + 4) * 3], 0.25, 1e-6);
  EXPECT_EQ(fxaa_filtered(dot, {.subpixel = 0}).pixels[(4 * 9 + 4) * 3], 1);
}

TEST(Fxaa, LittleContrastIsLeftAsItIs) {
  // Of luma, the root of these.
  std::mt19937 random(1);
  const auto noise = [&](double low, double high) {
    std::uniform_real_distribution<double> luma(low, high);
    return picture_of(20, 15, [&](std::size_t, std::size_t) {
      const double value = luma(random);
      return static_cast<float>(value * value);
    });
  };
  const Rendering dark = noise(0.1, 0.16);
  EXPECT_EQ(fxaa_filtered(dark).pixels, dark.pixels);
  const Rendering light = noise(0.82, 0.93);
  EXPECT_EQ(fxaa_filtered(light).pixels, light.pixels);
  const Rendering above_white = picture_of(
      20, 15, [](std::size_t x, std::size_t y) { return static_cast<float>(1 + x * y % 7); });
  EXPECT_EQ(fxaa_filtered(above_white).pixels, above_white.pixels);
  const Rendering strong = noise(0.1, 0.9);
  EXPECT_NE(fxaa_filtered(strong).pixels, strong.pixels);
}

TEST(Fxaa, TurnsAndMirrorsWithThePicture) {
  // Edges that are nearer to level than to upright, without a tie between the two.
  for (const double slope : {0.1, 0.22, -0.15, 0.4}) {
    const Rendering picture = picture_of(17, 17, [&](std::size_t x, std::size_t y) {
      const double height = 8.3 + slope * (static_cast<double>(x) - 8);
      return static_cast<double>(y) < height ? 0.9f : 0.2f;
    });
    const auto value = [](const Rendering& of, std::size_t x, std::size_t y) {
      return of.pixels[(y * 17 + x) * 3];
    };
    const Rendering filtered = fxaa_filtered(picture);
    EXPECT_NE(filtered.pixels, picture.pixels);
    const Rendering mirrored = fxaa_filtered(picture_of(
        17, 17, [&](std::size_t x, std::size_t y) { return value(picture, 16 - x, y); }));
    const Rendering overturned = fxaa_filtered(picture_of(
        17, 17, [&](std::size_t x, std::size_t y) { return value(picture, x, 16 - y); }));
    const Rendering transposed = fxaa_filtered(
        picture_of(17, 17, [&](std::size_t x, std::size_t y) { return value(picture, y, x); }));
    for (std::size_t y = 0; y < 17; ++y) {
      for (std::size_t x = 0; x < 17; ++x) {
        EXPECT_NEAR(value(filtered, x, y), value(mirrored, 16 - x, y), 1e-6) << x << ' ' << y;
        EXPECT_NEAR(value(filtered, x, y), value(overturned, x, 16 - y), 1e-6) << x << ' ' << y;
        EXPECT_NEAR(value(filtered, x, y), value(transposed, y, x), 1e-6) << x << ' ' << y;
      }
    }
  }
}

TEST(Fxaa, StaysBetweenThePixelAndItsNeighbours) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform;
  const Rendering picture =
      picture_of(31, 17, [&](std::size_t, std::size_t) { return uniform(random); });
  const Rendering filtered = fxaa_filtered(picture);
  for (std::size_t y = 0; y < 17; ++y) {
    for (std::size_t x = 0; x < 31; ++x) {
      const auto at = [&](std::size_t i, std::size_t j) {
        return picture
            .pixels[(std::min<std::size_t>(j, 16) * 31 + std::min<std::size_t>(i, 30)) * 3];
      };
      const auto [low, high] = std::minmax({at(x, y), at(x + 1, y), at(x, y + 1),
                                            at(x > 0 ? x - 1 : 0, y), at(x, y > 0 ? y - 1 : 0)});
      EXPECT_GE(filtered.pixels[(y * 31 + x) * 3], low - 1e-6f);
      EXPECT_LE(filtered.pixels[(y * 31 + x) * 3], high + 1e-6f);
    }
  }
}

TEST(Fxaa, HalvesTheErrorOfCentredSamplesAtANearlyLevelEdge) {
  const auto level = [](double x, double y) { return y + 0.15 * x < 20.3 ? 1.0 : 0.0; };
  const std::vector<double> means = pixel_means(48, 40, level);
  const Job job = job_at(48, 40, 1);
  const double centred = rms_error(supersampling(grey(level), job, {.jittered = false}), means);
  EXPECT_LT(rms_error(fxaa(grey(level), job), means), 0.5 * centred);
}

}  // namespace
}  // namespace baselines
