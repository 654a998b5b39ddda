// SPDX-License-Identifier: MIT
// Finished pixels are held within what the samples have shown.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <vector>

#include "freqsynth/image/pixel_finisher.h"
#include "support/fitted_block.h"

namespace freqsynth {
namespace {

using helpers::edge;
using helpers::FittedBlock;
using Block = std::array<float, max_terms>;

TEST(PixelBounds, BoundsKeepARingingFitWithinTheSamples) {
  FinishSettings settings;
  settings.shrinkage = 0;
  settings.butterworth.enabled = false;
  settings.slack = std::numeric_limits<double>::infinity();
  const FittedBlock block(100);
  const Block ringing = block.finished(100, settings);
  EXPECT_LT(*std::min_element(ringing.begin(), ringing.end()), -0.058f) << "-.073 was measured";
  EXPECT_GT(*std::max_element(ringing.begin(), ringing.end()), 1.058f);
  settings.slack = 0;
  for (const float pixel : block.finished(100, settings)) {
    EXPECT_GE(pixel, -1e-5f);
    EXPECT_LE(pixel, 1 + 1e-5f);
  }
}

TEST(PixelBounds, LiftsPixelsBelowZeroWhereNoSampleIs) {
  FinishSettings settings;
  settings.shrinkage = 0;
  settings.butterworth.enabled = false;
  settings.slack = std::numeric_limits<double>::infinity();
  const FittedBlock block(100);
  const Block ringing = block.finished(100, settings);
  float above = 0, below = 0;
  for (const float pixel : ringing) (pixel > 0 ? above : below) += pixel;
  ASSERT_LT(below, -0.3f);
  const Block lifted = block.finished(100, settings, {.positive = true});
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    const float expected = std::max(ringing[pixel], 0.0f) * (above + below) / above;
    EXPECT_NEAR(lifted[pixel], expected, 1e-5f) << pixel;
  }
  settings.keep_positive = false;
  EXPECT_EQ(block.finished(100, settings, {.positive = true}), ringing);
}

TEST(PixelBounds, HoldsFlatPixelsAtTheirSamples) {
  FinishSettings settings, off;
  settings.shrinkage = off.shrinkage = 0;
  settings.butterworth.enabled = off.butterworth.enabled = false;
  settings.ringing = 0.1;
  off.ringing = 0;
  const auto shown = [](int column, int row) {
    return static_cast<float>(edge((column + 0.5) / 8, (row + 0.5) / 8));
  };
  Block means;
  for (int i = 0; i < 64; ++i) means[static_cast<std::size_t>(i)] = shown(i % 8, i / 8);
  PixelEvidence evidence;
  evidence.own_means[4] = means.data();
  int changed = 0, kept = 0;
  for (const std::size_t samples : {50u, 64u, 100u, 150u, 256u}) {
    const FittedBlock block(samples);
    const Block ringing = block.finished(samples, off, evidence);
    const Block held = block.finished(samples, settings, evidence);
    for (int i = 0; i < 64; ++i) {
      const int column = i % 8, row = i / 8;
      int alike = 0;
      for (int v = std::max(row - 1, 0); v <= std::min(row + 1, 7); ++v) {
        for (int u = std::max(column - 1, 0); u <= std::min(column + 1, 7); ++u) {
          alike += (u != column || v != row) && shown(u, v) == shown(column, row) ? 1 : 0;
        }
      }
      const auto pixel = static_cast<std::size_t>(i);
      const float distance = std::abs(ringing[pixel] - means[pixel]);
      // The range of the block's means is 1.
      const bool is_held = alike == 8 || (alike >= 2 && distance <= 0.1f);
      EXPECT_NEAR(held[pixel], is_held ? means[pixel] : ringing[pixel], 1e-6f) << i;
      changed += is_held && distance > 1e-4f ? 1 : 0;
      kept += is_held ? 0 : 1;
    }
  }
  EXPECT_GT(changed, 10);
  EXPECT_GT(kept, 10);
}

// A fit that is far too bright everywhere becomes the upper bound everywhere: that of the pixels
// around, or, where less than four of these have samples, that of all.
TEST(PixelBounds, AreThoseOfThePixelsAroundOrOfAllWhereFewAreKnown) {
  const auto value = [](const SequencePosition& p) { return p.s * p.s + 0.3 * p.t; };
  FinishSettings settings;
  settings.shrinkage = settings.ringing = 0;
  settings.doubt = 1e6;
  settings.butterworth.enabled = false;
  int few = 0, enough = 0;
  for (const std::size_t samples : {4u, 9u, 20u, 30u, 45u, 64u}) {
    FittedBlock block(samples, [&](const SequencePosition& p, std::size_t) { return value(p); });
    block.residual = 1;
    block.coefficients = {400};
    const Block pixels = block.finished(samples, settings);
    std::vector<double> means(max_terms);  // not a number: no samples
    for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
      double sum = 0, weight = 0;
      for (std::size_t n = 0; n < samples; ++n) {
        const SequencePosition& p = block.list->position(n);
        weight += helpers::weight_in_pixel(p, pixel);
        sum += helpers::weight_in_pixel(p, pixel) * value(p);
      }
      means[pixel] = sum / weight;
    }
    for (int pixel = 0; pixel < 64; ++pixel) {
      std::vector<double> around, all;
      for (int other = 0; other < 64; ++other) {
        const double mean = means[static_cast<std::size_t>(other)];
        if (std::isnan(mean)) continue;
        all.push_back(mean);
        const int across = std::abs(pixel % 8 - other % 8), down = std::abs(pixel / 8 - other / 8);
        if (across <= 1 && down <= 1) around.push_back(mean);
      }
      (around.size() < 4 ? few : enough) += 1;
      std::vector<double>& used = around.size() < 4 ? all : around;
      std::sort(used.begin(), used.end());
      const double bound = used.back() + settings.slack * (used.back() - used[used.size() / 2]);
      EXPECT_NEAR(double{pixels[static_cast<std::size_t>(pixel)]}, bound, 1e-4)
          << samples << ", " << pixel;
    }
  }
  EXPECT_GT(few, 20);
  EXPECT_GT(enough, 20);
}

}  // namespace
}  // namespace freqsynth
