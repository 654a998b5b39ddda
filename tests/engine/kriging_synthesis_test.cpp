// SPDX-License-Identifier: MIT
// Synthesizer with a tree of nodes and a bank of priors: RefinerKind::kriging.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/node_pixels.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/image/tree_pictures.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/kriging_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::kriging_of;
using helpers::picture;
using helpers::random_kriging;
using helpers::RandomHost;
using helpers::RandomSynthesis;

std::vector<std::uint64_t> counters_of(const Synthesizer& engine) {
  const SynthesisStats stats = engine.stats();
  return {stats.samples,  stats.probes,      stats.differing_probes,
          stats.absorbed, stats.bad_samples, stats.ignored_bad_samples,
          stats.waves,    stats.blocks,      engine.bad_samples().size()};
}

/// \param finished  whether the bank's pictures are compared, too, whose lists take a while
void expect_same(const Synthesizer& one, const Synthesizer& other, bool finished) {
  EXPECT_EQ(counters_of(one), counters_of(other));
  EXPECT_EQ(one.image().save(), other.image().save());
  if (!finished) return;
  EXPECT_EQ(one.error_image(), other.error_image());
  EXPECT_EQ(one.finished_image().save(), other.finished_image().save());
}

using Calls = std::map<helpers::Point, int>;

/// What TreeSampler and TreePictures make of the same settings.
TEST(KrigingSynthesis, IsWhatTreeSamplerAndTreePicturesMake) {
  for (const double samples : {0.5, 1.5}) {
    SynthesisSettings settings = kriging_of(43, 37);
    settings.list.seed = 5;
    settings.wave = 7;
    Synthesizer engine(settings);
    Calls calls;
    const auto noted = [&](const Request& request) {
      if (!request.again) ++calls[{request.x, request.y}];
      return picture(request.x, request.y);
    };
    const StopRule stop = helpers::at_samples_per_pixel(samples);
    EXPECT_EQ(engine.run(noted, stop).reason, StopReason::samples);
    TreeSettings tree;
    tree.width = 43;
    tree.height = 37;
    tree.weights = {1};
    tree.seed = 5;
    tree.wave = 7;
    DirectionRule rule;
    TreeSampler sampler(tree, &rule);
    Calls expected;
    sampler.run(
        [&](double x, double y) {
          ++expected[{x, y}];
          return picture(x, y);
        },
        stop.most_samples(43, 37));
    EXPECT_EQ(calls, expected);
    EXPECT_EQ(engine.stats().samples, sampler.stats().samples);
    EXPECT_EQ(engine.stats().waves, sampler.stats().waves);
    EXPECT_EQ(engine.stats().absorbed, sampler.stats().absorbed);
    TreePictures pictures(sampler.tree().positions());
    const std::vector<float> pixels = pictures.pixels(sampler.tree());
    const std::vector<float> made = reconstruct(engine.finished_image());
    ASSERT_EQ(made.size(), pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      EXPECT_NEAR(made[i], std::max(pixels[i], 0.0f), 2e-5f);
    }
    SerialExecutor serial;
    const std::vector<float> rough = rough_pixels(sampler.tree(), serial);
    const std::vector<float> preview = reconstruct(engine.image());
    for (std::size_t i = 0; i < rough.size(); ++i) {
      EXPECT_NEAR(preview[i], std::max(rough[i], 0.0f), 2e-5f);
    }
    std::vector<float> finished(43 * 37);
    engine.finish({finished.data(), 43, 37});
    EXPECT_EQ(finished, made);
  }
}

TEST(KrigingSynthesis, IsTheSameWithSeveralThreadsAndAnyBatch) {
  SynthesisSettings settings = kriging_of(40, 29, 3);
  const auto sampler = [](double x, double y) {
    return std::array{picture(x, y), picture(y, x), 0.25f};
  };
  Synthesizer serial(settings);
  serial.run(sampler, at_samples(1200));
  for (const std::size_t threads : {1u, 3u}) {
    ThreadPool pool(threads);
    for (const std::size_t batch : {1u, 13u, 5000u}) {
      settings.packet = batch == 13 ? 4 : 1;
      Synthesizer engine(settings);
      std::atomic<std::uint64_t> calls = 0;
      engine.run(
          [&](double x, double y) {
            ++calls;
            return sampler(x, y);
          },
          at_samples(1200), pool, KeepGoing{}, batch);
      EXPECT_EQ(calls, helpers::calls_of(engine));
      expect_same(serial, engine, threads == 3 && batch == 13);
    }
  }
}

TEST(KrigingSynthesis, DoesNotDependOnTheOrderOfDelivery) {
  for (unsigned number = 0; number < 12; ++number) {
    SCOPED_TRACE(number);
    const RandomSynthesis synthesis = random_kriging(number);
    Synthesizer one(synthesis.settings), other(synthesis.settings);
    one.set_stop(synthesis.stop);
    other.set_stop(synthesis.stop);
    RandomHost(synthesis, 1).run(one);
    RandomHost(synthesis, 2).run(other);
    expect_same(one, other, number == 3);
    EXPECT_EQ(one.stats().abandoned, other.stats().abandoned);
    EXPECT_EQ(one.stopped(), other.stopped());
    EXPECT_LE(one.stats().samples, synthesis.stop.samples);
    EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(one.image())));
  }
}

TEST(KrigingSynthesis, ThrowingSamplerLosesNothing) {
  Synthesizer straight(kriging_of(44, 40));
  straight.run(picture, at_samples(2500));
  for (const std::size_t batch : {1u, 10u, 1024u}) {
    Synthesizer engine(kriging_of(44, 40));
    int calls = 0;
    const auto fatal = [&](double x, double y) {
      if (++calls % 301 == 0) throw std::runtime_error("no ray");
      return picture(x, y);
    };
    int thrown = 0;
    for (bool done = false; !done;) {
      try {
        engine.run(fatal, at_samples(2500), SerialExecutor{}, KeepGoing{}, batch);
        done = true;
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "no ray");
        ++thrown;
      }
    }
    EXPECT_GE(thrown, 8);
    EXPECT_EQ(static_cast<std::uint64_t>(calls - thrown), helpers::calls_of(engine));
    expect_same(straight, engine, false);
  }
}

TEST(KrigingSynthesis, CountsAndReportsBadValues) {
  Synthesizer engine(kriging_of(40, 32, 2));
  Calls bad;
  const auto sampler = [&](double x, double y) {
    const bool inside = std::hypot(x - 20, y - 12) < 3.9;
    if (inside) ++bad[{x, y}];
    return std::array{inside ? std::numeric_limits<float>::quiet_NaN() : picture(x, y),
                      picture(y, x)};
  };
  engine.run(sampler, at_samples(3000));
  EXPECT_GT(bad.size(), 10u);
  EXPECT_EQ(engine.stats().bad_samples, bad.size());
  Calls reported;
  for (const BadSample& one : engine.bad_samples()) reported[{one.x, one.y}] = bad[{one.x, one.y}];
  EXPECT_EQ(reported, bad);
  EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(engine.image())));
  // In a channel that does not steer they are no bad samples.
  SynthesisSettings settings = kriging_of(40, 32, 2);
  settings.channel_settings = {{.role = ChannelRole::passive}, {}};
  Synthesizer passive(settings);
  bad.clear();
  passive.run(sampler, at_samples(3000));
  EXPECT_EQ(passive.stats().bad_samples, 0u);
  EXPECT_EQ(passive.stats().ignored_bad_samples, bad.size());
}

TEST(KrigingSynthesis, NeverAUsableValueIsNoImage) {
  Synthesizer engine(kriging_of(40, 32));
  const auto none = [](double, double) { return std::numeric_limits<float>::quiet_NaN(); };
  EXPECT_EQ(engine.run(none, StopRule{}).reason, StopReason::unusable);
  EXPECT_LE(engine.stats().samples, 64u + 20u);
}

TEST(KrigingSynthesis, CancelEndsItUntilTheRuleIsSetAnew) {
  Synthesizer engine(kriging_of(32, 32));
  int batches = 0;
  const auto progress = [&](double) { return ++batches < 5; };
  EXPECT_EQ(engine.run(picture, at_samples(900), SerialExecutor{}, progress, 8).reason,
            StopReason::cancelled);
  EXPECT_EQ(batches, 5);
  engine.run(picture, at_samples(900));
  Synthesizer straight(kriging_of(32, 32));
  straight.run(picture, at_samples(900));
  expect_same(straight, engine, false);
}

TEST(KrigingSynthesis, NearestChannelsKeepValuesOfSamples) {
  SynthesisSettings settings = kriging_of(20, 20, 2);
  settings.channel_settings = {{}, {.role = ChannelRole::nearest}};
  Synthesizer engine(settings);
  engine.run(
      [](double x, double y) {
        return std::array{picture(x, y), static_cast<float>(x > 7.5 ? 3 : 8)};
      },
      at_samples(1200));
  EXPECT_EQ(engine.finished_image().channels(), 1u);
  for (const float value : engine.channel_pixels(1)) EXPECT_TRUE(value == 3 || value == 8);
}

TEST(KrigingSynthesis, NoiseIsSeenAndTold) {
  const auto noisy = [](const Request& request) {
    return picture(request.x, request.y) + 0.1f * static_cast<float>(request.seed % 1000) / 1000;
  };
  Synthesizer engine(kriging_of(40, 40));
  EXPECT_TRUE(engine.run(noisy, at_samples(2000)).noise_seen);
  EXPECT_TRUE(engine.noisy());
  Synthesizer quiet(kriging_of(40, 40));
  EXPECT_FALSE(quiet.run(picture, at_samples(2000)).noise_seen);
  EXPECT_GT(quiet.stats().probes, 20u);
  EXPECT_FALSE(quiet.noisy());
}

TEST(KrigingSynthesis, ErrorsFallAsTheyAreExpectedTo) {
  Synthesizer engine(kriging_of(64, 48));
  EXPECT_EQ(engine.predicted_rmse(), std::numeric_limits<double>::infinity());
  double before = std::numeric_limits<double>::infinity();
  for (const double samples : {0.125, 0.5, 1.5}) {
    engine.run(picture, helpers::at_samples_per_pixel(samples));
    const double expected = engine.predicted_rmse();
    EXPECT_LT(expected, 0.8 * before);
    before = expected;
    double sum = 0;
    const std::vector<float> errors = engine.error_image();
    for (const float error : errors) sum += double{error} * double{error};
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(errors.size())), expected, 1e-6);
    const double rmse = helpers::rmse_of(reconstruct(engine.finished_image()), 64, picture);
    EXPECT_GT(expected, 0.5 * rmse);
    EXPECT_LT(expected, 3 * rmse);
  }
}

}  // namespace
}  // namespace freqsynth
