// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "freqsynth/engine/error_watch.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ErrorWatch, LooksFourTimesWhileSamplesDouble) {
  for (const std::uint64_t blocks : {0u, 1u, 7u, 1000u}) {
    std::vector<std::uint64_t> looks;
    for (std::uint64_t at = 0; at < 1'000'000; looks.push_back(at)) {
      const std::uint64_t next = ErrorWatch::next_look(at, blocks);
      ASSERT_GT(next, at);
      ASSERT_GE(next, 5 * blocks);
      at = next;
    }
    const auto between = [&](std::uint64_t from, std::uint64_t to) {
      return std::count_if(looks.begin(), looks.end(),
                           [&](std::uint64_t look) { return look >= from && look < to; });
    };
    for (std::uint64_t from = 8192; from < 500'000; from *= 2)
      EXPECT_EQ(between(from, 2 * from), 4);
    EXPECT_EQ(between(0, 5 * blocks), 0);
    // From anywhere between two looks the next one is the same.
    for (std::size_t i = 0; i + 1 < looks.size(); ++i) {
      EXPECT_EQ(ErrorWatch::next_look(looks[i + 1] - 1, blocks), looks[i + 1]);
    }
  }
}

TEST(ErrorWatch, PassesAPlaceOnceAndPredictsOnceThere) {
  ErrorWatch watch(10);
  EXPECT_FALSE(watch.due(49));
  EXPECT_EQ(watch.last(), infinity);
  int calls = 0;
  const auto predict = [&] { return ++calls == 1 ? 0.25 : 0.5; };
  EXPECT_TRUE(watch.due(50));
  EXPECT_EQ(watch.look(50, predict), 0.25);
  EXPECT_EQ(watch.look(50, predict), 0.25);
  EXPECT_TRUE(watch.due(50)) << "until a wave begins";
  watch.pass(50);
  EXPECT_FALSE(watch.due(50));
  EXPECT_FALSE(watch.due(55));
  EXPECT_TRUE(watch.due(56));
  EXPECT_EQ(watch.look(60, predict), 0.5);
  EXPECT_EQ(watch.last(), 0.5);
  EXPECT_EQ(watch.least(), 0.25);
  EXPECT_EQ(calls, 2);
}

double rmse(const Synthesizer& engine, const auto& function) {
  return helpers::rmse_of(reconstruct(engine.finished_image()), engine.settings().width, function);
}

TEST(TargetRmse, EndsWhenTheExpectedErrorIsThatSmall) {
  std::uint64_t before = 0;
  for (const double target : {0.05, 0.02, 0.01, 0.005}) {
    Synthesizer engine(settings_of(96, 80));
    const RunReport report = engine.run(picture, {.target_rmse = target});
    EXPECT_EQ(report.reason, StopReason::target_rmse);
    EXPECT_EQ(engine.stopped(), StopReason::target_rmse);
    EXPECT_LE(engine.predicted_rmse(), target);
    EXPECT_EQ(engine.progress().predicted_rmse, engine.predicted_rmse());
    EXPECT_EQ(engine.progress().fraction, 1);
    const double samples = static_cast<double>(engine.stats().samples);
    EXPECT_GT(engine.stats().samples, before);
    before = engine.stats().samples;
    // Not for nothing: with three quarters of the samples the error was not expected to be so small
    // at a look, so it was hardly so small in between. And about as small it is.
    Synthesizer less(settings_of(96, 80));
    less.run(picture, at_samples(static_cast<std::uint64_t>(0.7 * samples)));
    EXPECT_GT(less.predicted_rmse(), 0.9 * target);
    EXPECT_LT(rmse(engine, picture), 1.5 * target) << target;
    EXPECT_GT(rmse(engine, picture), 0.3 * target) << target;
  }
}

TEST(TargetRmse, EndsAtTheSameSampleWhateverHappensOnTheWay) {
  for (const double target : {0.03, 0.008}) {
    for (const std::size_t wave : {0u, 1u, 13u}) {
      const SynthesisSettings settings = settings_of(60, 44, 1, wave);
      const StopRule stop{.target_rmse = target};
      Synthesizer straight(settings);
      EXPECT_EQ(straight.run(picture, stop).reason, StopReason::target_rmse);
      const auto same = [&](const Synthesizer& engine) {
        return engine.stats().samples == straight.stats().samples &&
               helpers::same_image(engine.image(), straight.image());
      };
      ThreadPool pool(3);
      Synthesizer parallel(settings);
      parallel.run(picture, stop, pool, KeepGoing{}, 5);
      EXPECT_TRUE(same(parallel));
      // Cancelled, out of time, with other rules, asked in vain, looked at by others.
      Synthesizer engine(settings);
      oracle::Random random(5);
      RunReport report;
      do {
        std::size_t patience = 1 + random.below(40);
        report =
            engine.run(picture, stop, SerialExecutor{}, [&](double) { return --patience > 0; });
        if (report.reason == StopReason::target_rmse) break;
        if (random.below(3) == 0) engine.run(picture, {.seconds = 0});
        if (random.below(3) == 0) {
          engine.set_stop({.target_rmse = 1e-9});
          EXPECT_FALSE(engine.stopped());
        }
        if (random.below(3) == 0) static_cast<void>(engine.predicted_rmse());
      } while (true);
      EXPECT_TRUE(same(engine));
      // It is reached, and nothing is asked for again.
      EXPECT_EQ(engine.run(picture, stop).reason, StopReason::target_rmse);
      EXPECT_TRUE(same(engine));
      // A smaller one goes on.
      EXPECT_EQ(engine.run(picture, {.target_rmse = target / 2}).reason, StopReason::target_rmse);
      EXPECT_GT(engine.stats().samples, straight.stats().samples);
    }
  }
}

TEST(TargetRmse, EndsAtTheSameSampleWhenItIsSavedOnTheWay) {
  const SynthesisSettings settings = settings_of(60, 44);
  const StopRule stop{.target_rmse = 0.01};
  Synthesizer straight(settings);
  straight.run(picture, stop);
  oracle::Random random(8);
  for (int round = 0; round < 5; ++round) {
    auto engine = std::make_unique<Synthesizer>(settings);
    std::size_t patience = 1;
    while (engine->run(picture, stop, SerialExecutor{}, [&](double) { return --patience > 0; })
               .reason == StopReason::cancelled) {
      const double seen = engine->progress().predicted_rmse;
      engine = std::make_unique<Synthesizer>(settings, engine->save());
      EXPECT_EQ(engine->progress().predicted_rmse, seen);
      patience = 1 + random.below(60);
    }
    EXPECT_EQ(engine->stats().samples, straight.stats().samples);
    EXPECT_TRUE(helpers::same_image(engine->image(), straight.image()));
  }
}

TEST(TargetRmse, ThatCannotBeMetEndsByAnotherRule) {
  SynthesisSettings settings = settings_of(40, 32);
  settings.max_samples_per_block = 40;
  Synthesizer engine(settings);
  EXPECT_EQ(engine.run(picture, {.target_rmse = 1e-12}).reason, StopReason::exhausted);
  EXPECT_LT(engine.progress().predicted_rmse, 1) << "it was looked at";
  settings = settings_of(40, 32);
  settings.importance.assign(20, 1.0f);
  settings.importance[7] = 0;
  settings.max_samples_per_block = 40;
  Synthesizer partial(settings);
  EXPECT_EQ(partial.run(picture, {.target_rmse = 1e-12}).reason, StopReason::threshold)
      << "the block without importance is all that is left";
  Synthesizer few(settings_of(40, 32));
  EXPECT_EQ(few.run(picture, {.samples = 300, .target_rmse = 1e-12}).reason, StopReason::samples);
  EXPECT_EQ(few.stats().samples, 300u);
}

TEST(TargetRmse, OfInfinityIsMetAtTheFirstLookAndOfZeroNever) {
  Synthesizer engine(settings_of(40, 32));
  EXPECT_EQ(engine.run(picture, {.target_rmse = infinity}).reason, StopReason::target_rmse);
  EXPECT_GE(engine.stats().absorbed, 100u) << "5 in each of 20 blocks";
  EXPECT_LE(engine.stats().absorbed, 110u);
  Synthesizer flat(settings_of(40, 32));
  EXPECT_EQ(flat.run([](double, double) { return 0.0f; }, at_samples(900)).reason,
            StopReason::samples);
  EXPECT_EQ(flat.progress().predicted_rmse, infinity) << "nobody looked";
}

TEST(TargetRmse, IsToldByProgressThatRises) {
  Synthesizer engine(settings_of(96, 80));
  std::vector<double> fractions;
  std::vector<std::uint64_t> samples;
  std::size_t others = 0;
  double last = infinity;
  engine.run(picture, {.samples_per_pixel = 50, .target_rmse = 0.01}, SerialExecutor{},
             [&](const Progress& now) {
               fractions.push_back(now.fraction);
               samples.push_back(now.samples);
               others += now.predicted_rmse != last ? 1 : 0;
               last = now.predicted_rmse;
               return true;
             });
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(std::count(fractions.begin(), fractions.end(), 1.0), 1);
  EXPECT_EQ(fractions.back(), 1);
  EXPECT_GE(others, 5u);
  EXPECT_LE(last, 0.01);
  // With half of the samples it is not below a tenth: it tells something.
  const auto half = std::lower_bound(samples.begin(), samples.end(), samples.back() / 2);
  EXPECT_GT(fractions[static_cast<std::size_t>(half - samples.begin())], 0.1);
}

TEST(TargetRmse, InALoopOfTheHostsOwn) {
  Synthesizer straight(settings_of(60, 44)), engine(settings_of(60, 44));
  straight.run(picture, {.target_rmse = 0.01});
  engine.set_stop({.target_rmse = 0.01});
  std::vector<Request> requests(7);
  while (const std::size_t count = engine.request(requests, Wait::until_available)) {
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(picture(requests[i].x, requests[i].y));
    }
    engine.deliver(std::span<const Request>(requests).first(count), values);
  }
  EXPECT_EQ(engine.stopped(), StopReason::target_rmse);
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(TargetRmse, OfNoiseIsMetToo) {
  Synthesizer engine(settings_of(64, 64));
  const auto noisy = [](const Request& request) {
    const double noise = static_cast<double>(request.seed >> 11) * 0x1p-53 - 0.5;
    return picture(request.x, request.y) + static_cast<float>(noise);
  };
  EXPECT_EQ(engine.run(noisy, {.samples_per_pixel = 200, .target_rmse = 0.04}).reason,
            StopReason::target_rmse);
  EXPECT_LT(rmse(engine, picture), 2 * 0.04);
}

}  // namespace
}  // namespace freqsynth
