// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <thread>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

constexpr std::uint64_t samples = 1777;

std::array<float, 2> colour(double x, double y) { return {picture(x, y), picture(y, 2 * x)}; }

SynthesisSettings usual(std::size_t wave) { return settings_of(52, 43, 2, wave); }

FrequencyImage reference(std::size_t wave) {
  Synthesizer engine(usual(wave));
  engine.run(colour, at_samples(samples));
  return engine.image();
}

void deliver_values(Synthesizer& engine, std::span<const Request> requests) {
  std::vector<float> values;
  for (const Request& request : requests) {
    for (const float value : colour(request.x, request.y)) values.push_back(value);
  }
  engine.deliver(requests, values);
}

class WaveSize : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Waves, WaveSize, testing::Values(0, 1, 5, 42, 100000));

TEST_P(WaveSize, RequestAndDeliverInAnyOrderIsRun) {
  const FrequencyImage expected = reference(GetParam());
  for (unsigned seed = 0; seed < 8; ++seed) {
    oracle::Random random(seed);
    Synthesizer engine(usual(GetParam()));
    engine.set_stop(at_samples(samples));
    std::vector<Request> in_flight;
    while (true) {
      std::vector<Request> fresh(random.below(20) + 1);
      fresh.resize(engine.request(fresh));
      in_flight.insert(in_flight.end(), fresh.begin(), fresh.end());
      if (in_flight.empty()) break;
      std::shuffle(in_flight.begin(), in_flight.end(), random.engine());
      // Some come back without a value, some in one delivery, the others later.
      if (random.below(4) == 0) {
        const auto back = std::span<const Request>(in_flight).last(1);
        engine.give_back(back);
        in_flight.pop_back();
      }
      const std::size_t count =
          fresh.empty() ? in_flight.size() : random.below(in_flight.size() + 1);
      deliver_values(engine, std::span<const Request>(in_flight).last(count));
      in_flight.resize(in_flight.size() - count);
    }
    EXPECT_EQ(engine.stopped(), StopReason::samples);
    EXPECT_EQ(engine.stats().samples, samples);
    EXPECT_TRUE(helpers::same_image(engine.image(), expected)) << "seed " << seed;
  }
}

TEST_P(WaveSize, BatchSizeDoesNotMatter) {
  const FrequencyImage expected = reference(GetParam());
  for (const std::size_t batch : {1u, 2u, 7u, 100000u}) {
    Synthesizer engine(usual(GetParam()));
    engine.run(colour, at_samples(samples), SerialExecutor{}, KeepGoing{}, batch);
    EXPECT_TRUE(helpers::same_image(engine.image(), expected)) << "batch " << batch;
  }
}

TEST_P(WaveSize, NumberOfThreadsDoesNotMatter) {
  const FrequencyImage expected = reference(GetParam());
  for (const std::size_t threads : {1u, 2u, 4u}) {
    ThreadPool pool(threads);
    Synthesizer engine(usual(GetParam()));
    engine.run(colour, at_samples(samples), pool);
    EXPECT_TRUE(helpers::same_image(engine.image(), expected)) << threads << " threads";
    EXPECT_EQ(engine.stats().samples, samples);
  }
}

/// Runs tasks backwards: any order is allowed.
struct ReverseExecutor {
  static void execute(std::size_t count, TaskRef task) {
    while (count > 0) task(--count);
  }
  static std::size_t concurrency() { return 3; }
};

TEST_P(WaveSize, ExecutorMayBeTheHosts) {
  Synthesizer engine(usual(GetParam()));
  engine.run(colour, at_samples(samples), ReverseExecutor{});
  EXPECT_TRUE(helpers::same_image(engine.image(), reference(GetParam())));
}

TEST_P(WaveSize, HostsThreadsMayRequestAndDeliverAtTheSameTime) {
  Synthesizer engine(usual(GetParam()));
  engine.set_stop(at_samples(samples));
  const auto work = [&] {
    while (true) {
      std::array<Request, 3> requests;
      const std::size_t count = engine.request(requests);
      deliver_values(engine, std::span<const Request>(requests).first(count));
      if (count > 0) continue;
      if (engine.stopped() == StopReason::samples) return;
      std::this_thread::yield();  // the others owe the rest of the wave
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(helpers::same_image(engine.image(), reference(GetParam())));
}

TEST(Determinism, InterruptedRunsGiveTheSameImage) {
  const FrequencyImage expected = reference(0);
  for (const std::size_t batch : {1u, 3u, 50u}) {
    Synthesizer engine(usual(0));
    std::size_t calls = 0, runs = 0;
    RunReport report;
    do {
      std::size_t batches = 0;
      report = engine.run(
          [&](double x, double y) {
            ++calls;
            return colour(x, y);
          },
          at_samples(samples), SerialExecutor{}, [&](double) { return ++batches < 7; }, batch);
      ++runs;
      ASSERT_EQ(helpers::calls_of(engine), calls) << "nothing that was delivered is lost";
    } while (report.reason == StopReason::cancelled);
    EXPECT_EQ(report.reason, StopReason::samples);
    EXPECT_EQ(engine.stats().samples, samples);
    EXPECT_GT(runs, 100u) << "132 were measured";
    EXPECT_TRUE(helpers::same_image(engine.image(), expected));
  }
}

TEST(Determinism, CancelStopsAfterTheBatch) {
  Synthesizer engine(usual(100));
  std::size_t calls = 0;
  const RunReport report = engine.run(
      [&](double x, double y) {
        ++calls;
        return colour(x, y);
      },
      StopRule{}, SerialExecutor{}, [](double) { return false; }, 16);
  EXPECT_EQ(report.reason, StopReason::cancelled);
  EXPECT_LE(calls, 16u);
}

TEST(Determinism, ReportsTheTimeOfTheSamplerAndTheRest) {
  using Clock = std::chrono::steady_clock;
  Synthesizer engine(usual(100));
  const auto begin = Clock::now();
  const RunReport report = engine.run(
      [&](double x, double y) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return colour(x, y);
      },
      at_samples(20));
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
  EXPECT_GE(report.sampler_seconds, 0.020);
  EXPECT_GT(report.core_seconds, 0);
  EXPECT_LE(report.sampler_seconds + report.core_seconds, elapsed);
}

}  // namespace
}  // namespace freqsynth
