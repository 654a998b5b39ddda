// SPDX-License-Identifier: MIT
// No block stays behind the others for good.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/engine/exploration.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

/// Busy on the right, flat on the left.
double half(double x, double y) { return x > 64 && std::sin(0.05 * x * y) > 0 ? 1 : 0; }

std::vector<std::uint32_t> counts_with(double exploration, double spp) {
  SynthesisSettings settings = helpers::settings_of(128, 64);
  settings.priority.exploration = exploration;
  Synthesizer engine(settings);
  engine.run(half, helpers::at_samples_per_pixel(spp));
  return helpers::counts_of(engine.image());
}

TEST(Exploration, GivesEveryBlockAPowerOfTheMean) {
  for (const double exploration : {0.5, 0.82, 0.95}) {
    for (const double spp : {0.25, 1.0, 4.0}) {
      const auto counts = counts_with(exploration, spp);
      double sum = 0;
      for (const std::uint32_t count : counts) sum += count;
      const double least = std::pow(sum / static_cast<double>(counts.size()), exploration);
      // The last sample of each block may still be on its way.
      EXPECT_GE(*std::min_element(counts.begin(), counts.end()), std::floor(least) - 1)
          << exploration << ", " << spp;
    }
  }
}

TEST(Exploration, OfOneGivesAllBlocksTheSame) {
  const auto counts = counts_with(1, 2);
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  // What neighbours give for nothing comes in runs.
  EXPECT_LE(*most - *least, 2 * SampleSequence::longest_border_run);
}

TEST(Exploration, OfZeroLeavesFlatBlocksAlone) {
  const auto with = counts_with(0.82, 4), without = counts_with(0, 4);
  EXPECT_LT(2 * *std::min_element(without.begin(), without.end()),
            *std::min_element(with.begin(), with.end()));
}

TEST(Exploration, LeavesNoBlockBelowItsLeastSamplesOnceThereAreSoMany) {
  for (const double exploration : {0.0, 0.82}) {
    for (const std::size_t least : {5u, 25u, 60u}) {
      SynthesisSettings settings = helpers::settings_of(128, 64);
      settings.priority.exploration = exploration;
      settings.least_samples_per_block = least;
      Synthesizer engine(settings);
      // As many requests as that would take if blocks shared none, and a little more.
      engine.run(half, helpers::at_samples(128 * (least + 2)));
      auto counts = helpers::counts_of(engine.image());
      EXPECT_GE(*std::min_element(counts.begin(), counts.end()), least);
      // Then errors decide.
      engine.run(half, helpers::at_samples(128 * (least + 40)));
      counts = helpers::counts_of(engine.image());
      std::uint64_t left = 0, right = 0;
      for (std::size_t b = 0; b < counts.size(); ++b) (b % 16 < 7 ? left : right) += counts[b];
      EXPECT_LT(2 * left, right) << least;
    }
  }
  SynthesisSettings settings = helpers::settings_of(128, 64);
  settings.max_samples_per_block = 30;
  settings.least_samples_per_block = 31;
  try {
    Synthesizer engine(settings);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "freqsynth: least_samples_per_block is 31, not in 0..30");
  }
}

TEST(Exploration, VisitsThoseThatLagUntilNoneIsTaken) {
  std::vector<double> samples{5, 1, 9, 2, 1};
  const auto lags = [&](std::uint32_t block, double least) { return samples[block] < least; };
  Exploration exploration(0.5, samples.size());
  exploration.update(9.5, lags);
  EXPECT_EQ(exploration.least(), 4);
  std::vector<std::uint32_t> taken;
  exploration.visit(lags, [&](std::uint32_t block) {
    if (taken.size() == 2) return false;
    taken.push_back(block);
    return true;
  });
  samples[4] = 4;
  exploration.visit(lags, [&](std::uint32_t block) {
    taken.push_back(block);
    return true;
  });
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{1, 3}));
}

TEST(Exploration, OutsideOfItsRangeIsRefused) {
  for (const double exploration : {-0.1, 1.1, std::nan("")}) {
    SynthesisSettings settings = helpers::settings_of(16, 16);
    settings.priority.exploration = exploration;
    EXPECT_THROW(Synthesizer{settings}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace freqsynth
