// SPDX-License-Identifier: MIT
#include "baselines/corner_subdivision.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "baseline_helpers.h"
#include "baselines/supersampling.h"

namespace baselines {
namespace {

TEST(CornerSubdivision, TakesTheCornersOfPixelsAloneWhereTheyDoNotDiffer) {
  const Rendering flat = corner_subdivision(constant(0.25f, 0.5f, 3), job_at(9, 7, 20));
  EXPECT_EQ(total_samples(flat), 10u * 8u);
  // Differences of 0.27 and 0.33, summed over three colours, on both sides of the threshold.
  for (const auto& [contrast, divided] : {std::pair{0.09, false}, {0.11, true}}) {
    const auto edge = [contrast = contrast](double x, double) { return x < 4.5 ? 0 : contrast; };
    EXPECT_EQ(total_samples(corner_subdivision(grey(edge), job_at(9, 7, 20))) > 10u * 8u, divided);
  }
  // More than white is as good as white.
  const auto bright = [](double x, double) { return x < 4.5 ? 2.0 : 9.0; };
  EXPECT_EQ(total_samples(corner_subdivision(grey(bright), job_at(9, 7, 20))), 10u * 8u);
}

TEST(CornerSubdivision, IsThePixelsCornersMeanWithoutDivision) {
  const auto ramp = [](double x, double y) { return 0.01 * x + 0.02 * y; };
  const Rendering rendering = corner_subdivision(grey(ramp), job_at(9, 7, 4));
  EXPECT_LT(rms_error(rendering, pixel_means(9, 7, ramp)), 1e-6);
}

TEST(CornerSubdivision, AnEdgeIsFoundToAnEighthOfAPixel) {
  // At 2.3: half of the strip from 2.25 to 2.375 counts as bright, with four steps of depth half of
  // that from 2.25 to 2.3125.
  const auto edge = [](double x, double) { return x < 2.3 ? 1.0 : 0.0; };
  for (const auto& [depth, expected] :
       {std::pair{0u, 0.5}, {1u, 0.25}, {2u, 0.375}, {3u, 0.3125}, {4u, 0.28125}}) {
    const Rendering rendering = corner_subdivision(grey(edge), job_at(6, 4, 300), {.depth = depth});
    for (std::size_t i = 0; i < 24; ++i) {
      const std::size_t x = i % 6;
      EXPECT_NEAR(rendering.pixels[i * 3], x < 2 ? 1 : x > 2 ? 0 : expected, 1e-6) << depth;
    }
  }
}

TEST(CornerSubdivision, SamplesLieOnALatticeAndNoneIsTakenTwice) {
  std::set<std::pair<double, double>> positions;
  std::uint64_t calls = 0;
  const Radiance radiance = [&](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
    EXPECT_EQ(x * 8, std::floor(x * 8));
    EXPECT_EQ(y * 8, std::floor(y * 8));
    positions.emplace(x, y);
    ++calls;
    std::fill(rgb.begin(), rgb.end(), static_cast<float>(slanted_edge(x, y)));
  };
  const Rendering rendering = corner_subdivision(radiance, job_at(32, 32, 16));
  EXPECT_EQ(positions.size(), calls);
  EXPECT_EQ(total_samples(rendering), calls);
  EXPECT_LT(calls, 16u * 32 * 32) << "an edge does not need all";
}

TEST(CornerSubdivision, TheGreatestDifferencesComeFirstWhenSamplesAreFew) {
  // Two edges, the fainter one on the left: ten samples more than the corners need.
  const auto edges = [](double x, double) { return x < 2.3 ? 0.4 : x < 6.3 ? 0.0 : 1.0; };
  const Rendering rendering = corner_subdivision(grey(edges), {9, 7, 10 * 8 + 10, 0});
  EXPECT_LE(total_samples(rendering), 90u);
  EXPECT_GE(total_samples(rendering), 86u) << "a division takes up to five";
  for (std::size_t y = 0; y < 7; ++y) {
    EXPECT_NEAR(rendering.pixels[(y * 9 + 2) * 3], 0.2, 1e-6) << "undivided";
  }
  EXPECT_NEAR(rendering.pixels[6 * 3], 0.75, 0.13);
  EXPECT_NE(rendering.pixels[6 * 3], 0.5f);
}

TEST(CornerSubdivision, IsARegularGridBelowTheCornersOfPixels) {
  const Job job{8, 6, 9 * 7 - 1, 0};
  const auto wave = [](double x, double y) { return 1 + std::sin(3 * x + y); };
  EXPECT_EQ(corner_subdivision(grey(wave), job).pixels,
            supersampling(grey(wave), job, {.jittered = false}).pixels);
}

}  // namespace
}  // namespace baselines
