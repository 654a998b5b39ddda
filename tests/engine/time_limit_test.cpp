// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::counts_of;
using helpers::picture;
using helpers::settings_of;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Clock = std::chrono::steady_clock;

constexpr double infinity = std::numeric_limits<double>::infinity();

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

TEST(TimeLimit, EndsARunThatWouldTakeVeryLong) {
  Synthesizer engine(settings_of(64, 64));
  const auto slow = [](double x, double y) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return picture(x, y);
  };
  for (int run = 0; run < 2; ++run) {
    const auto begin = Clock::now();
    const RunReport report = engine.run(slow, {.seconds = 0.03}, SerialExecutor{}, KeepGoing{}, 1);
    EXPECT_EQ(report.reason, StopReason::seconds);
    EXPECT_EQ(engine.stopped(), StopReason::seconds);
    EXPECT_GE(seconds_since(begin), 0.03) << "counted anew in each run";
  }
}

TEST(TimeLimit, OfNothingAsksForNothing) {
  Synthesizer engine(settings_of(64, 64));
  EXPECT_EQ(engine.run(picture, {.seconds = 0}).reason, StopReason::seconds);
  EXPECT_EQ(engine.stats().samples, 0u);
  std::vector<Request> requests(10);
  EXPECT_EQ(engine.request(requests, Wait::until_available), 0u);
}

TEST(TimeLimit, InTheMiddleOfAWaveLosesNothing) {
  Synthesizer straight(settings_of(64, 64, 1, 30)), engine(settings_of(64, 64, 1, 30));
  straight.run(picture, at_samples(600));
  std::vector<Request> requests(7);
  std::vector<float> values;
  std::uint64_t delivered = 0;
  while (true) {
    engine.set_stop(at_samples(600));
    requests.resize(7);
    requests.resize(engine.request(requests));
    if (requests.empty()) break;
    engine.set_stop({.seconds = 0});
    EXPECT_EQ(engine.stopped(), StopReason::seconds) << "though most of the wave waits";
    std::vector<Request> more(7);
    EXPECT_EQ(engine.request(more, Wait::until_available), 0u);
    values.clear();
    for (const Request& request : requests) values.push_back(picture(request.x, request.y));
    engine.deliver(requests, values);
    delivered += requests.size();
    ASSERT_EQ(helpers::calls_of(engine), delivered);
  }
  EXPECT_EQ(engine.stopped(), StopReason::samples);
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(TimeLimit, WakesThreadsThatWait) {
  Synthesizer engine(settings_of(64, 64, 1, 30));
  std::vector<Request> all(100);
  all.resize(engine.request(all));
  engine.set_stop({.seconds = 0.02});
  std::vector<Request> more(7);
  EXPECT_EQ(engine.request(more, Wait::until_available), 0u) << "nobody ever answers";
  EXPECT_EQ(engine.stopped(), StopReason::seconds);
}

TEST(StopRules, ThatAreNoNumbersAreRefusedByName) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Synthesizer engine(settings_of(16, 16));
  for (const double wrong : {nan, -nan, -1.0, -1e-300, -infinity}) {
    const auto refused = [&](const StopRule& stop, const std::string& name) {
      const auto message = ThrowsMessage<std::invalid_argument>(HasSubstr(name + " is "));
      EXPECT_THAT([&] { engine.set_stop(stop); }, message);
      EXPECT_THAT([&] { engine.run(picture, stop); }, message);
    };
    refused({.samples_per_pixel = wrong}, "samples_per_pixel");
    refused({.seconds = wrong}, "seconds");
    refused({.target_rmse = wrong}, "target_rmse");
    refused({.aliasing_threshold = wrong}, "aliasing_threshold");
  }
  EXPECT_EQ(engine.run(picture, at_samples(10)).reason, StopReason::samples);
}

/// Rules in any combination: the end comes, and the rule that is named holds.
TEST(StopRules, InAnyCombinationEndAndTellWhich) {
  oracle::Random random(7);
  std::size_t reasons[8] = {};
  for (int round = 0; round < 400; ++round) {
    SynthesisSettings settings =
        settings_of(random.below(33), 1 + random.below(33), 1, random.below(20));
    settings.max_samples_per_block = 1 + random.below(60);
    Synthesizer engine(settings);
    StopRule stop;
    const auto one_in = [&](std::size_t n) { return random.below(n) == 0; };
    if (one_in(2)) stop.samples = random.below(800);
    if (one_in(3)) stop.samples_per_pixel = static_cast<double>(random.below(300)) / 100;
    if (one_in(3)) stop.aliasing_threshold = one_in(3) ? infinity : 0.003;
    if (one_in(3)) stop.least_samples = random.below(100);
    if (one_in(3)) stop.seconds = one_in(2) ? 1e5 : 1e-4 * static_cast<double>(random.below(3));
    bool cancelled = false;
    const std::size_t patience = random.below(200);
    std::size_t calls = 0;
    const auto begin = Clock::now();
    const RunReport report = engine.run(picture, stop, SerialExecutor{}, [&](const Progress& now) {
      cancelled = cancelled || (++calls > patience && now.fraction < 1);
      return !cancelled;
    });
    const std::uint64_t most = stop.most_samples(settings.width, settings.height);
    EXPECT_LE(engine.stats().samples, most);
    const std::vector<std::uint32_t> counts = counts_of(engine.image());
    bool full = true, lattice = true;
    for (const std::uint32_t count : counts) {
      EXPECT_LE(count, settings.max_samples_per_block);
      full = full && count == settings.max_samples_per_block;
      lattice = lattice && count >= std::min(stop.least_samples, settings.max_samples_per_block);
    }
    EXPECT_EQ(report.reason == StopReason::cancelled, cancelled);
    switch (report.reason) {
      case StopReason::samples:
        EXPECT_EQ(engine.stats().samples, most);
        break;
      case StopReason::seconds:
        EXPECT_GE(seconds_since(begin), stop.seconds);
        break;
      case StopReason::threshold:
        EXPECT_GT(stop.aliasing_threshold, 0);
        EXPECT_TRUE(lattice);
        break;
      case StopReason::exhausted:
        EXPECT_TRUE(full);
        break;
      default:
        EXPECT_TRUE(cancelled);
    }
    ++reasons[static_cast<int>(report.reason)];
  }
  for (const StopReason reason : {StopReason::samples, StopReason::threshold, StopReason::exhausted,
                                  StopReason::cancelled, StopReason::seconds}) {
    EXPECT_GE(reasons[static_cast<int>(reason)], 10u) << static_cast<int>(reason);
  }
}

}  // namespace
}  // namespace freqsynth
