// SPDX-License-Identifier: MIT
#include "freqsynth/engine/stop_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::counts_of;
using helpers::picture;
using helpers::settings_of;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// A dot of the size of a pixel on black.
auto dot_at(double x0, double y0) {
  return [=](double x, double y) { return std::hypot(x - x0, y - y0) < 0.6 ? 1.0f : 0.0f; };
}

TEST(StopRule, ThresholdLooksAtALatticeFirst) {
  for (const std::size_t least : {0u, 1u, 4u, 25u, 81u}) {
    for (const std::size_t wave : {0u, 1u, 5u, 1000u}) {
      SynthesisSettings settings = settings_of(64, 64, 1, wave);
      Synthesizer engine(settings);
      const StopRule stop{.aliasing_threshold = 0.01, .least_samples = least};
      EXPECT_EQ(engine.run(dot_at(20.3, 33.9), stop).reason, StopReason::threshold);
      const std::vector<std::uint32_t> counts = counts_of(engine.image());
      EXPECT_GE(*std::min_element(counts.begin(), counts.end()), std::max<std::size_t>(least, 1))
          << wave;
    }
  }
  EXPECT_EQ(StopRule{}.least_samples, 25u);
}

TEST(StopRule, ThresholdWithItsLatticeFindsADot) {
  // On the lattice of 5 x 5, and nowhere near a corner.
  SynthesisSettings settings = settings_of(64, 64);
  settings.list.positions = SamplePositions::lattice;
  Synthesizer engine(settings);
  engine.run(dot_at(20, 36), {.aliasing_threshold = 0.01});
  EXPECT_GT(engine.image().samples(2, 4), 50u) << "seen, and looked at: twice the lattice";
}

TEST(StopRule, LeastSamplesLeavesOutBlocksWithoutImportanceAndFullOnes) {
  SynthesisSettings settings = settings_of(40, 8);
  settings.importance = {1, 0, 1, 0, 1};
  Synthesizer engine(settings);
  engine.run([](double, double) { return 0.5f; }, {.aliasing_threshold = 0.5});
  for (std::size_t x = 0; x < 5; ++x) {
    const std::uint32_t samples = engine.image().samples(x, 0);
    EXPECT_EQ(samples >= 25, x % 2 == 0) << x << ": " << samples;
  }
  settings = settings_of(40, 8);
  settings.max_samples_per_block = 10;
  Synthesizer small(settings);
  EXPECT_EQ(small.run(picture, {.aliasing_threshold = 1e9}).reason, StopReason::exhausted);
  for (const std::uint32_t count : counts_of(small.image())) EXPECT_EQ(count, 10u);
}

TEST(StopRule, MostSamplesRounds) {
  const auto most = [](double per_pixel, std::uint64_t samples = ~std::uint64_t{0}) {
    return StopRule{.samples_per_pixel = per_pixel, .samples = samples}.most_samples(10, 7);
  };
  EXPECT_EQ(most(1), 70u);
  EXPECT_EQ(most(0.1), 7u);
  EXPECT_EQ(most(0.107), 7u);
  EXPECT_EQ(most(0.108), 8u);
  EXPECT_EQ(most(0), 0u);
  EXPECT_EQ(most(1, 69), 69u);
  EXPECT_EQ(most(1e300), ~std::uint64_t{0});
  EXPECT_EQ(most(std::numeric_limits<double>::infinity(), 5), 5u);
}

TEST(Unusable, ASamplerWithoutAUsableValueIsNoSuccess) {
  for (const std::size_t width : {8u, 13u, 64u}) {
    for (const float value : {nan, std::numeric_limits<float>::infinity(), 1e37f, -2e36f}) {
      const auto sampler = [&](double, double) { return value; };
      for (const StopRule& stop : {StopRule{}, StopRule{.samples_per_pixel = 1000},
                                   StopRule{.aliasing_threshold = 0.1}, at_samples(3)}) {
        Synthesizer engine(settings_of(width, 40));
        EXPECT_EQ(engine.run(sampler, stop).reason, StopReason::unusable);
        EXPECT_EQ(engine.stopped(), StopReason::unusable);
        EXPECT_EQ(engine.stats().bad_samples, engine.stats().samples);
        EXPECT_LE(engine.stats().samples, 64 + 2 * engine.stats().blocks);
      }
    }
  }
}

TEST(Unusable, OneUsableValueIsEnough) {
  Synthesizer engine(settings_of(64, 40, 2));
  const auto sampler = [](double x, double y) {
    return std::array{nan, x == 8 && y == 16 ? 0.5f : nan};
  };
  EXPECT_EQ(engine.run(sampler, at_samples(2000)).reason, StopReason::samples);
  EXPECT_EQ(engine.stats().samples, 2000u);
}

TEST(Unusable, ARunWithABetterSamplerGoesOn) {
  Synthesizer engine(settings_of(64, 40));
  engine.run([](double, double) { return nan; }, at_samples(1000));
  EXPECT_EQ(engine.stopped(), StopReason::unusable);
  EXPECT_EQ(engine.run(picture, at_samples(1000)).reason, StopReason::samples);
  EXPECT_EQ(engine.stats().samples, 1000u);
}

TEST(Unusable, AnImageWithoutBlocksIsDone) {
  Synthesizer engine(settings_of(0, 0));
  EXPECT_EQ(engine.run([](double, double) { return nan; }, {}).reason, StopReason::exhausted);
}

/// A small deterministic random number.
std::uint32_t random_number(std::uint32_t& state, std::uint32_t below) {
  state = state * 1664525u + 1013904223u;
  return (state >> 8) % below;
}

TEST(MaxSamples, AreNeverExceeded) {
  std::uint32_t state = 1;
  std::size_t at_the_limit = 0;
  for (int round = 0; round < 400; ++round) {
    SynthesisSettings settings =
        settings_of(1 + random_number(state, 50), 1 + random_number(state, 50),
                    1 + random_number(state, 3), random_number(state, 12));
    settings.max_samples_per_block = 1 + random_number(state, 60);
    settings.list.seed = random_number(state, 100);
    const std::size_t channels = settings.channels;
    Synthesizer engine(settings);
    const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = picture(requests[i / channels].x, requests[i / channels].y);
      }
    };
    const RunReport report =
        engine.run(sampler, round % 2 == 0 ? StopRule{} : at_samples(random_number(state, 800)));
    for (const std::uint32_t count : counts_of(engine.image())) {
      ASSERT_LE(count, settings.max_samples_per_block);
      at_the_limit += count == settings.max_samples_per_block ? 1 : 0;
    }
    if (report.reason == StopReason::exhausted) {
      for (const std::uint32_t count : counts_of(engine.image())) {
        ASSERT_EQ(count, settings.max_samples_per_block);
      }
    }
  }
  EXPECT_GT(at_the_limit, 1000u);
}

TEST(MaxSamples, ByDefaultEndNothingThatAnyoneAskedFor) {
  // 4096 as the limit ended this at 62 samples per pixel as exhausted.
  Synthesizer engine(settings_of(16, 16));
  EXPECT_EQ(engine.run(picture, {.samples_per_pixel = 80}).reason, StopReason::samples);
  EXPECT_EQ(engine.stats().samples, 80u * 256);
}

}  // namespace
}  // namespace freqsynth
