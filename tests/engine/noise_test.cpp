// SPDX-License-Identifier: MIT
// Noise is noticed: some samples are asked for twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::coefficients_of;
using helpers::settings_of;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

double smooth(double x, double y) { return 2 + std::sin(0.3 * x) * std::cos(0.2 * y); }

/// A random number in [0, 1) of a request.
double chance(const Request& request) { return static_cast<double>(request.seed >> 11) * 0x1p-53; }

struct Call {
  Request request;
  float value;
};

/// Runs a sampler of requests and notes its calls.
template <class Sampler>
std::vector<Call> calls_of(Synthesizer& engine, const StopRule& stop, Sampler sampler) {
  std::vector<Call> calls;
  engine.run(
      [&](const Request& request) {
        calls.push_back({request, static_cast<float>(sampler(request))});
        return calls.back().value;
      },
      stop);
  return calls;
}

TEST(Noise, OnlyAFewPointsAreAskedForTwiceUnderOtherNames) {
  for (const Noise noise : {Noise::automatic, Noise::none, Noise::present}) {
    for (const std::size_t wave : {0u, 1u, 1000u}) {
      SynthesisSettings settings = settings_of(53, 40, 1, wave);
      settings.noise = noise;
      Synthesizer engine(settings);
      const auto calls = calls_of(engine, {.samples = 5000}, chance);
      std::map<std::pair<double, double>, std::vector<Request>> points;
      std::set<std::uint64_t> ids, seeds;
      for (const auto& [request, value] : calls) {
        points[{request.x, request.y}].push_back(request);
        ids.insert(request.id);
        seeds.insert(request.seed);
      }
      const SynthesisStats stats = engine.stats();
      EXPECT_EQ(stats.samples, 5000u);
      EXPECT_EQ(points.size(), 5000u);
      // All of these have their probe for k = 2 .. 70, and perhaps for 71.
      EXPECT_GE(stats.probes, 69u);
      EXPECT_LE(stats.probes, 70u);
      EXPECT_EQ(calls.size(), stats.samples + stats.probes);
      EXPECT_EQ(ids.size(), calls.size());
      EXPECT_EQ(seeds.size(), calls.size());
      EXPECT_EQ(stats.differing_probes, stats.probes);
      for (const auto& [point, requests] : points) {
        ASSERT_LE(requests.size(), 2u);
        if (requests.size() == 1) continue;
        EXPECT_EQ(requests[0].pixel, requests[1].pixel);
        EXPECT_EQ(requests[0].spacing, requests[1].spacing);
        EXPECT_LT(requests[0].ordinal, requests[1].ordinal);
      }
    }
  }
}

TEST(Noise, WithoutNoiseAllSettingsGiveTheSameSamplesAndFits) {
  // But for the finish: nothing but what is seen of noise matters.
  for (const bool bad : {false, true}) {
    const auto sampler = [bad](double x, double y) {
      return bad && x > 20 && y < 9 ? std::numeric_limits<double>::infinity() : smooth(x, y);
    };
    std::vector<std::vector<float>> fits, finished;
    for (const Noise noise : {Noise::automatic, Noise::none, Noise::present}) {
      SynthesisSettings settings = settings_of(53, 40);
      settings.noise = noise;
      Synthesizer engine(settings);
      const RunReport report = engine.run(sampler, {.samples_per_pixel = 3});
      EXPECT_FALSE(report.noise_seen);
      EXPECT_GT(engine.stats().probes, 70u);
      EXPECT_EQ(engine.stats().differing_probes, 0u);
      EXPECT_EQ(engine.noisy(), noise == Noise::present);
      fits.push_back(coefficients_of(engine.image()));
      finished.push_back(coefficients_of(engine.finished_image()));
    }
    EXPECT_EQ(fits[1], fits[0]);
    EXPECT_EQ(fits[2], fits[0]);
    EXPECT_EQ(finished[1], finished[0]);
    EXPECT_NE(finished[2], finished[0]);
  }
}

TEST(Noise, IsNoticedAndFinishedAsIfItHadBeenSaid) {
  const auto sampler = [](const Request& request) {
    return smooth(request.x, request.y) * (0.5 + chance(request));
  };
  std::vector<std::vector<float>> fits, finished;
  for (const Noise noise : {Noise::automatic, Noise::none, Noise::present}) {
    SynthesisSettings settings = settings_of(53, 40);
    settings.noise = noise;
    Synthesizer engine(settings);
    EXPECT_TRUE(engine.run(sampler, {.samples_per_pixel = 3}).noise_seen) << "reported always";
    EXPECT_EQ(engine.noisy(), noise != Noise::none);
    fits.push_back(coefficients_of(engine.image()));
    finished.push_back(coefficients_of(engine.finished_image()));
  }
  EXPECT_EQ(fits[1], fits[0]) << "linear steering does not ask";
  EXPECT_EQ(fits[2], fits[0]);
  EXPECT_NE(finished[1], finished[0]);
  EXPECT_EQ(finished[2], finished[0]);
}

TEST(Noise, ASamplerThatSeesPositionsOnlyIsNoticed) {
  oracle::Random random(1);
  Synthesizer engine(settings_of(64, 64));
  engine.run([&](double x, double y) { return smooth(x, y) + random.uniform(0, 0.01); },
             {.samples_per_pixel = 0.0625});
  EXPECT_TRUE(engine.noisy());
}

TEST(Noise, IsNoticedInASmallPartOfThePicture) {
  // One of 16 blocks has noise; at a quarter of a sample per pixel 31 points are asked for twice,
  // at 1 sample 63. Noise attracts samples.
  std::size_t seen = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SynthesisSettings settings = settings_of(64, 64);
    settings.list.seed = seed;
    Synthesizer engine(settings);
    const auto noisy_corner = [](const Request& request) {
      const bool corner = request.x > 48 && request.y > 48;
      return corner ? 2 * chance(request) : 0.5 + 0.001 * request.x;
    };
    engine.run(noisy_corner, {.samples_per_pixel = 1});
    seen += engine.noisy() ? 1 : 0;
  }
  EXPECT_EQ(seen, 20u);
}

TEST(Noise, TheRarerItIsTheLaterItIsNoticed) {
  // A probe of hits with probability p differs with 2 p (1 - p), so after n samples noise has been
  // missed with probability (1 - 2 p (1 - p))^root(n).
  for (const double p : {0.1, 0.02, 0.005}) {
    for (const double rate : {1.0, 4.0}) {
      std::size_t missed = 0;
      constexpr unsigned runs = 60;
      const double expected =
          runs * std::pow(1 - 2 * p * (1 - p), std::floor(std::sqrt(rate * 64 * 64)) - 1);
      for (unsigned seed = 0; seed < runs; ++seed) {
        SynthesisSettings settings = settings_of(64, 64);
        settings.seed = seed;
        Synthesizer engine(settings);
        engine.run([&](const Request& request) { return chance(request) < p ? 1 / p : 0; },
                   {.samples_per_pixel = rate});
        missed += engine.noisy() ? 0 : 1;
      }
      // Within four standard deviations of the binomial distribution, and one.
      const double deviation = std::sqrt(expected * (1 - expected / runs));
      EXPECT_NEAR(static_cast<double>(missed), expected, 4 * deviation + 1) << p << ", " << rate;
    }
  }
}

TEST(Noise, OfChannelsThatDoNotSteerSaysNothing) {
  SynthesisSettings settings = settings_of(64, 64, 4);
  settings.channel_settings = {
      {}, {ChannelRole::passive}, {ChannelRole::nearest}, {ChannelRole::mean}};
  Synthesizer engine(settings);
  engine.run(
      [](const Request& request) {
        const auto noise = chance(request);
        return std::array{smooth(request.x, request.y), noise, noise, noise};
      },
      {.samples_per_pixel = 2});
  EXPECT_EQ(engine.stats().differing_probes, 0u);
  EXPECT_FALSE(engine.noisy());
}

TEST(Noise, TwoValuesOfAPointAreOneSampleTheirMean) {
  // A block with four samples of one term: its constant is their mean.
  std::map<std::pair<double, double>, std::vector<float>> points;
  SynthesisSettings settings = settings_of(8, 8);
  settings.list.max_terms = 1;
  Synthesizer engine(settings);
  for (const auto& [request, value] : calls_of(engine, {.samples = 100}, chance)) {
    points[{request.x, request.y}].push_back(value);
  }
  double sum = 0;
  std::size_t twice = 0;
  for (const auto& [point, values] : points) {
    for (const float value : values) sum += double{value} / static_cast<double>(values.size());
    twice += values.size() - 1;
  }
  EXPECT_EQ(twice, 9u) << "for k = 2 .. 10";
  EXPECT_EQ(points.size(), 100u);
  EXPECT_NEAR(engine.image().coefficients(0, 0, 0)[0] / 8, sum / 100, 1e-6);
}

TEST(Noise, ASecondValueStandsInForABadOne) {
  Synthesizer engine(settings_of(24, 24));
  std::set<std::pair<double, double>> seen;
  std::size_t again = 0;
  const auto bad_at_first = [&](double x, double y) {
    if (seen.insert({x, y}).second) return nan;
    ++again;
    return 1.0f;
  };
  engine.run(bad_at_first, {.samples = 400});
  EXPECT_GT(again, 15u);
  EXPECT_EQ(engine.stats().bad_samples, engine.stats().samples - again);
  EXPECT_EQ(engine.stats().differing_probes, 0u);
}

class NoisySteering : public testing::TestWithParam<Steer> {};
INSTANTIATE_TEST_SUITE_P(Steers, NoisySteering,
                         testing::Values(Steer::linear, Steer::relative, Steer::display));

/// Noise in one place, so that it is noticed some time.
double partly_noisy(const Request& request) {
  const double value = smooth(request.x, request.y) / 3;
  return request.x > 40 ? value * (0.5 + chance(request)) : value;
}

TEST_P(NoisySteering, TheMomentOfNoticingDoesNotDependOnThreadsBatchOrOrder) {
  SynthesisSettings settings = settings_of(61, 45);
  settings.priority.steer = GetParam();
  const auto render = [&](std::size_t batch, std::size_t threads) {
    Synthesizer engine(settings);
    ThreadPool pool(threads);
    engine.run(partly_noisy, {.samples_per_pixel = 2}, pool, KeepGoing{}, batch);
    EXPECT_TRUE(engine.noisy());
    return coefficients_of(engine.finished_image());
  };
  const auto expected = render(1024, 1);
  EXPECT_EQ(render(5, 1), expected);
  EXPECT_EQ(render(64, 3), expected);
  for (unsigned seed = 0; seed < 3; ++seed) {
    oracle::Random random(seed);
    Synthesizer engine(settings);
    engine.set_stop({.samples_per_pixel = 2});
    std::vector<Request> owed;
    while (true) {
      std::vector<Request> fresh(random.below(50) + 1);
      fresh.resize(engine.request(fresh));
      owed.insert(owed.end(), fresh.begin(), fresh.end());
      if (owed.empty()) break;
      std::shuffle(owed.begin(), owed.end(), random.engine());
      const auto value = static_cast<float>(partly_noisy(owed.back()));
      if (random.below(5) == 0) {
        engine.give_back({&owed.back(), 1});
      } else {
        engine.deliver({&owed.back(), 1}, {&value, 1});
      }
      owed.pop_back();
    }
    EXPECT_EQ(engine.stats().samples, 5490u);
    EXPECT_EQ(coefficients_of(engine.finished_image()), expected);
  }
}

TEST(Noise, SteeringKnowsOfItFromThenOn) {
  // A block that has had more than a sample per pixel counts by the inverse of it where there is no
  // noise; see Steering::gain().
  const auto most_sampled = [](Noise noise) {
    SynthesisSettings settings = settings_of(64, 64);
    settings.priority.steer = Steer::relative;
    settings.priority.exploration = 0;
    settings.noise = noise;
    Synthesizer engine(settings);
    engine.run(
        [](const Request& request) {
          const bool loud = request.x < 8 && request.y < 8;
          return 1 + (loud ? 1.0 : 0.1) * (chance(request) - 0.5);
        },
        {.samples_per_pixel = 4});
    return engine.image().samples(0, 0);
  };
  EXPECT_GT(most_sampled(Noise::automatic), 0.9 * most_sampled(Noise::present));
  EXPECT_LT(most_sampled(Noise::none), 0.7 * most_sampled(Noise::automatic));
}

}  // namespace
}  // namespace freqsynth
