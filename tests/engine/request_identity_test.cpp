// SPDX-License-Identifier: MIT
// What a request tells of its sample beside the position: pixel, ordinal, seed and thread.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
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

/// All that is told of samples, by id.
struct Identity {
  double x, y;
  std::uint64_t seed, pixel;
  std::uint32_t ordinal;
  bool again;

  friend bool operator==(const Identity&, const Identity&) = default;
};
using Identities = std::map<std::uint64_t, Identity>;

void keep(Identities& all, const Request& r) {
  const auto [place, is_new] =
      all.insert({r.id, Identity{r.x, r.y, r.seed, r.pixel, r.ordinal, r.again}});
  EXPECT_TRUE(is_new) << r.id;
}

Identities identities_of(const SynthesisSettings& settings, std::uint64_t samples) {
  Synthesizer engine(settings);
  Identities all;
  engine.run(
      [&](const Request& r) {
        keep(all, r);
        return picture(r.x, r.y);
      },
      at_samples(samples));
  EXPECT_EQ(engine.stats().samples, samples);
  EXPECT_EQ(all.size(), helpers::calls_of(engine));
  return all;
}

TEST(Ordinal, CountsTheSamplesOfEachPixelInTheOrderOfRequests) {
  using Size = std::pair<std::size_t, std::size_t>;
  // Also images whose last blocks are a pixel wide, and one that is nothing else.
  for (const Size& size : {Size{40, 32}, Size{52, 43}, Size{17, 9}, Size{3, 8}, Size{1, 1}}) {
    const std::size_t width = size.first, height = size.second;
    for (const std::size_t wave : {0u, 1u, 7u}) {
      Synthesizer engine(settings_of(width, height, 1, wave));
      std::vector<std::uint32_t> counts(width * height);
      const std::uint64_t samples = 6 * width * height + 11;
      engine.run(
          [&](const Request& r) {
            const std::size_t x = std::min(static_cast<std::size_t>(std::floor(r.x)), width - 1);
            const std::size_t y = std::min(static_cast<std::size_t>(std::floor(r.y)), height - 1);
            EXPECT_EQ(r.pixel, y * width + x);
            EXPECT_EQ(r.ordinal, counts[y * width + x]++) << r.x << ' ' << r.y;
            return picture(r.x, r.y);
          },
          at_samples(samples));
      EXPECT_EQ(engine.stats().samples, samples);
    }
  }
}

TEST(RequestIdentity, DoesNotDependOnBatchesAndOrder) {
  constexpr std::uint64_t samples = 5000;
  SynthesisSettings settings = settings_of(52, 43, 1, 11);
  settings.seed = 9;
  const Identities expected = identities_of(settings, samples);
  for (unsigned seed = 0; seed < 4; ++seed) {
    oracle::Random random(seed);
    Synthesizer engine(settings);
    engine.set_stop(at_samples(samples));
    Identities all;
    std::vector<Request> in_flight;
    std::size_t returned = 0;
    while (true) {
      std::vector<Request> fresh(random.below(20) + 1);
      fresh.resize(engine.request(fresh));
      in_flight.insert(in_flight.end(), fresh.begin(), fresh.end());
      if (in_flight.empty()) break;
      std::shuffle(in_flight.begin(), in_flight.end(), random.engine());
      if (random.below(4) == 0) {
        engine.give_back(std::span<const Request>(in_flight).last(1));
        in_flight.pop_back();
        ++returned;
      }
      const std::size_t count =
          fresh.empty() ? in_flight.size() : random.below(in_flight.size() + 1);
      const auto answered = std::span<const Request>(in_flight).last(count);
      std::vector<float> values;
      for (const Request& r : answered) {
        keep(all, r);
        EXPECT_EQ(r.thread, 0u);
        values.push_back(picture(r.x, r.y));
      }
      engine.deliver(answered, values);
      in_flight.resize(in_flight.size() - count);
    }
    EXPECT_GT(returned, 100u);
    EXPECT_TRUE(all == expected) << seed;
  }
}

TEST(RequestIdentity, DoesNotDependOnSeveralThreads) {
  constexpr std::uint64_t samples = 5000;
  const SynthesisSettings settings = settings_of(52, 43, 1, 29);
  const Identities expected = identities_of(settings, samples);
  for (const std::size_t threads : {2u, 5u}) {
    ThreadPool pool(threads);
    Synthesizer engine(settings);
    Identities all;
    std::mutex mutex;
    engine.run(
        [&](const Request& r) {
          const std::lock_guard lock(mutex);
          keep(all, r);
          return picture(r.x, r.y);
        },
        at_samples(samples), pool, KeepGoing{}, 13);
    EXPECT_TRUE(all == expected) << threads;
  }
}

TEST(RequestSeed, DependsOnTheSettingsSeedAndMovesNoSample) {
  constexpr std::uint64_t samples = 4000;
  SynthesisSettings settings = settings_of(52, 43);
  std::set<std::uint64_t> seeds;
  const Identities first = identities_of(settings, samples);
  for (const std::uint64_t seed : {0u, 1u, 2u, 77u}) {
    settings.seed = seed;
    for (const auto& [id, identity] : identities_of(settings, samples)) {
      seeds.insert(identity.seed);
      Identity unseeded = first.at(id);
      unseeded.seed = identity.seed;
      ASSERT_TRUE(identity == unseeded) << id;
    }
  }
  EXPECT_EQ(seeds.size(), 4 * first.size()) << "within and between pictures no two are equal";
}

TEST(RequestSeed, IsWellMixed) {
  // Each bit is set in half of all seeds and, from one sample to the next and from one picture to
  // another, changes in half of all cases: n = 4000, five deviations are 158.
  constexpr std::uint64_t samples = 4000;
  SynthesisSettings settings = settings_of(52, 43);
  const Identities these = identities_of(settings, samples);
  settings.seed = 1;
  const Identities others = identities_of(settings, samples);
  std::array<int, 64> set{}, changed{}, differs{};
  std::uint64_t before = 0;
  for (const auto& [id, identity] : these) {
    if (identity.again) continue;
    for (unsigned bit = 0; bit < 64; ++bit) {
      set[bit] += static_cast<int>(identity.seed >> bit & 1);
      changed[bit] += static_cast<int>((identity.seed ^ before) >> bit & 1);
      differs[bit] += static_cast<int>((identity.seed ^ others.at(id).seed) >> bit & 1);
    }
    before = identity.seed;
  }
  for (unsigned bit = 0; bit < 64; ++bit) {
    EXPECT_NEAR(set[bit], samples / 2, 158) << bit;
    EXPECT_NEAR(changed[bit], samples / 2, 158) << bit;
    EXPECT_NEAR(differs[bit], samples / 2, 158) << bit;
  }
}

/// Counts who has a number at the same time.
struct Watch {
  std::array<std::atomic<int>, 64> holders{};
  std::atomic<int> shared{0};
  std::atomic<std::uint32_t> most{0};
  std::atomic<std::size_t> calls{0};

  float operator()(const Request& r) {
    if (holders[r.thread].fetch_add(1) != 0) ++shared;
    ++calls;
    std::uint32_t seen = most;
    while (seen < r.thread && !most.compare_exchange_weak(seen, r.thread)) {
    }
    if (calls % 8 == 0) std::this_thread::yield();
    --holders[r.thread];
    return picture(r.x, r.y);
  }
};

TEST(RequestThread, IsSharedByNoTwoCallsOfSeveralThreads) {
  for (const std::size_t threads : {1u, 2u, 3u, 7u}) {
    ThreadPool pool(threads);
    Watch watch;
    Synthesizer engine(settings_of(104, 80, 1, 130));
    engine.run(watch, at_samples(20000), pool, KeepGoing{}, 64);
    EXPECT_EQ(watch.calls, helpers::calls_of(engine));
    EXPECT_EQ(watch.shared, 0) << threads;
    EXPECT_LT(watch.most, threads);
  }
}

/// Runs eight tasks at a time and owns up to two.
struct LyingExecutor {
  static void execute(std::size_t count, TaskRef task) {
    std::vector<std::thread> all;
    for (std::size_t i = 0; i < count; ++i) all.emplace_back([=] { task(i); });
    for (std::thread& thread : all) thread.join();
  }
  static std::size_t concurrency() { return 2; }
};

TEST(RequestThread, IsSharedByNoTwoCallsOfAnExecutorThatLies) {
  Watch watch;
  Synthesizer engine(settings_of(104, 80, 1, 130));
  engine.run(watch, at_samples(3000), LyingExecutor{}, KeepGoing{}, 64);
  EXPECT_EQ(watch.calls, helpers::calls_of(engine));
  EXPECT_EQ(watch.shared, 0);
}

}  // namespace
}  // namespace freqsynth
