// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/engine/stop_meter.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Never falling, in 0..1, and 1 at the last one only.
void expect_rising(const std::vector<double>& fractions) {
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GE(fractions.front(), 0);
  EXPECT_EQ(std::count(fractions.begin(), fractions.end(), 1.0), 1);
  EXPECT_EQ(fractions.back(), 1);
}

std::vector<double> fractions_of(Synthesizer& engine, const StopRule& stop, std::size_t batch) {
  std::vector<double> fractions;
  engine.run(
      picture, stop, SerialExecutor{},
      [&](double fraction) {
        fractions.push_back(fraction);
        return true;
      },
      batch);
  return fractions;
}

TEST(Progress, IsTheShareOfTheSamples) {
  Synthesizer engine(settings_of(52, 43));
  std::vector<double> shares;
  std::size_t asked = 0;
  engine.run(
      [&](const Request& request) {
        asked += request.again ? 0 : 1;
        return picture(request.x, request.y);
      },
      at_samples(500), SerialExecutor{},
      [&](double share) {
        EXPECT_DOUBLE_EQ(share, static_cast<double>(asked) / 500);
        shares.push_back(share);
        return true;
      },
      4);
  expect_rising(shares);
  // A wave is a 32nd of the blocks, here one: a call of the progress for every sample.
  EXPECT_EQ(shares.size(), 500u);
}

TEST(Progress, WithoutALimitIsTheShareOfAllSamplesThatBlocksMayHave) {
  SynthesisSettings settings = settings_of(52, 43);
  settings.max_samples_per_block = 25;
  Synthesizer engine(settings);
  std::vector<double> shares;
  engine.run(picture, StopRule{}, SerialExecutor{}, [&](double share) {
    const SynthesisStats stats = engine.stats();
    EXPECT_DOUBLE_EQ(share, static_cast<double>(stats.absorbed) / static_cast<double>(42 * 25));
    shares.push_back(share);
    return true;
  });
  expect_rising(shares);
}

TEST(Progress, RisesToOneWhateverTheEnd) {
  oracle::Random random(3);
  std::size_t reasons[8] = {};
  for (int round = 0; round < 300; ++round) {
    SynthesisSettings settings = settings_of(1 + random.below(40), 1 + random.below(40), 1,
                                             random.below(3) == 0 ? 0 : random.below(9));
    settings.max_samples_per_block = 1 + random.below(40);
    Synthesizer engine(settings);
    StopRule stop;
    if (random.below(2) == 0) stop.samples = 1 + random.below(400);
    if (random.below(2) == 0) stop.aliasing_threshold = 0.01;
    if (random.below(2) == 0) stop.least_samples = random.below(30);
    if (random.below(4) == 0) stop.seconds = 1e-4 * static_cast<double>(random.below(3));
    if (random.below(4) == 0) stop.samples_per_pixel = 0.5;
    std::vector<double> fractions;
    std::uint64_t before = 0;
    const RunReport report = engine.run(
        picture, stop, SerialExecutor{},
        [&](const Progress& now) {
          fractions.push_back(now.fraction);
          EXPECT_EQ(now.samples, engine.stats().samples);
          EXPECT_EQ(now.revision, engine.stats().waves);
          EXPECT_GE(now.revision, before);
          before = now.revision;
          EXPECT_GE(now.seconds, 0);
          EXPECT_GE(now.seconds_left, 0);
          EXPECT_TRUE(now.fraction < 1 || now.seconds_left == 0);
          return true;
        },
        1 + random.below(20));
    expect_rising(fractions);
    EXPECT_EQ(engine.progress().fraction, 1);
    EXPECT_EQ(engine.progress().seconds_left, 0);
    ++reasons[static_cast<int>(report.reason)];
  }
  for (const StopReason reason :
       {StopReason::samples, StopReason::threshold, StopReason::exhausted, StopReason::seconds}) {
    EXPECT_GE(reasons[static_cast<int>(reason)], 10u) << static_cast<int>(reason);
  }
}

TEST(Progress, IsNotOneWhileASecondValueIsOwed) {
  // A wave of all samples, some of which are asked for twice.
  Synthesizer engine(settings_of(40, 32, 1, 20));
  engine.set_stop(at_samples(20));
  std::vector<Request> requests(100);
  requests.resize(engine.request(requests));
  ASSERT_GT(requests.size(), 20u);
  ASSERT_TRUE(requests.back().again);
  const std::vector<float> values(requests.size(), 0.5f);
  const std::size_t last = requests.size() - 1;
  engine.deliver(std::span<const Request>(requests).first(last), std::span(values).first(last));
  EXPECT_EQ(engine.progress().samples, 20u);
  EXPECT_LT(engine.progress().fraction, 1);
  EXPECT_GT(engine.progress().fraction, 0.999);
  EXPECT_EQ(engine.progress().revision, 0u);
  engine.deliver(std::span<const Request>(requests).subspan(last), std::span(values).subspan(last));
  EXPECT_EQ(engine.progress().fraction, 1);
  EXPECT_EQ(engine.progress().revision, 1u);
}

TEST(Progress, OfARunThatIsCancelledIsNotOne) {
  Synthesizer engine(settings_of(40, 32));
  int calls = 0;
  const auto cancel = [&](const Progress& now) {
    EXPECT_LT(now.fraction, 1);
    return ++calls < 5;
  };
  EXPECT_EQ(engine.run(picture, at_samples(100), SerialExecutor{}, cancel).reason,
            StopReason::cancelled);
  EXPECT_EQ(calls, 5);
  EXPECT_DOUBLE_EQ(engine.progress().fraction, 0.05);
  expect_rising(fractions_of(engine, at_samples(100), 7));
}

TEST(Progress, OfARunThatHasNothingToDoIsTold) {
  Synthesizer engine(settings_of(40, 32));
  EXPECT_EQ(fractions_of(engine, at_samples(0), 1), std::vector<double>{1});
  Synthesizer none(settings_of(0, 0));
  EXPECT_EQ(fractions_of(none, {}, 1), std::vector<double>{1});
  EXPECT_EQ(engine.progress().samples, 0u);
}

TEST(StopMeter, TellsTheRuleThatIsFurthestAndThePaceSinceItsBeginning) {
  StopMeter meter;
  const auto left_of = [&](const StopMeter::Shares& now) {
    const Progress progress = meter.progress(now, false);
    return progress.seconds_left / progress.seconds;
  };
  meter.begin(infinity, {0.25, 0.5});
  EXPECT_EQ(meter.deadline(), std::nullopt);
  EXPECT_EQ(meter.progress({0.25, 0.5}, false).seconds_left, infinity) << "nothing has happened";
  EXPECT_EQ(meter.progress({0.25, 0.5}, false).fraction, 0.5);
  EXPECT_NEAR(left_of({0.5, 0.5}), 2, 1e-9) << "a quarter is done, two are left";
  EXPECT_NEAR(left_of({0.5, 0.75}), 1, 1e-9) << "the other rule comes first";
  EXPECT_EQ(meter.progress({0.75, 0.5}, false).fraction, 0.75);
  EXPECT_EQ(meter.progress({0.75, 0.5}, true).fraction, 1);
  // A limit that was lowered and passed is the end only when the wave is complete.
  EXPECT_EQ(meter.progress({1.5, 0.5}, false).seconds_left, 0);
  EXPECT_EQ(meter.progress({1.5, 0.5}, false).fraction, std::nextafter(1, 0));
}

TEST(StopMeter, CountsSecondsFromItsBeginning) {
  StopMeter meter;
  const auto before = StopMeter::Clock::now();
  meter.begin(1000, {});
  const auto after = StopMeter::Clock::now();
  ASSERT_TRUE(meter.deadline());
  EXPECT_GE(*meter.deadline(), before + std::chrono::seconds(1000));
  EXPECT_LE(*meter.deadline(), after + std::chrono::seconds(1001));
  EXPECT_FALSE(meter.out_of_time());
  const Progress now = meter.progress({}, false);
  EXPECT_DOUBLE_EQ(now.seconds + now.seconds_left, 1000);
  EXPECT_DOUBLE_EQ(now.fraction, now.seconds / 1000);
  meter.begin(0, {});
  EXPECT_TRUE(meter.out_of_time());
  for (const double never : {infinity, 1e10, 1e300}) {
    meter.begin(never, {});
    EXPECT_FALSE(meter.deadline()) << never;
    EXPECT_FALSE(meter.out_of_time());
  }
}

}  // namespace
}  // namespace freqsynth
