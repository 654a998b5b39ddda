// SPDX-License-Identifier: MIT
// Engines that are saved and loaded go on as if nothing had happened.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/basis/archive.h"
#include "freqsynth/engine/state_archive.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/random_synthesis.h"

namespace freqsynth {
namespace {

using helpers::RandomHost;
using helpers::RandomSynthesis;
using Bytes = std::vector<std::byte>;

/// Every bit of what a host can see, images aside.
std::vector<std::uint64_t> numbers_of(const Synthesizer& engine) {
  const SynthesisStats stats = engine.stats();
  std::vector<std::uint64_t> numbers{stats.samples,          stats.probes,
                                     stats.differing_probes, stats.absorbed,
                                     stats.bad_samples,      stats.ignored_bad_samples,
                                     stats.abandoned,        stats.waves,
                                     stats.blocks,           engine.noisy() ? 1u : 0u};
  for (const BadSample& one : engine.bad_samples()) {
    numbers.push_back(std::bit_cast<std::uint64_t>(one.x));
    numbers.push_back(std::bit_cast<std::uint64_t>(one.y));
    numbers.push_back(one.id);
  }
  const std::vector<ChannelSettings>& roles = engine.settings().channel_settings;
  for (std::size_t c = 0; c < roles.size(); ++c) {
    if (has_coefficients(roles[c].role)) continue;
    for (const float value : engine.channel_pixels(c)) {
      numbers.push_back(std::bit_cast<std::uint32_t>(value));
    }
  }
  return numbers;
}

void expect_same(const Synthesizer& one, const Synthesizer& other) {
  EXPECT_EQ(numbers_of(one), numbers_of(other));
  EXPECT_EQ(one.image().save(), other.image().save());
  EXPECT_EQ(one.error_image(), other.error_image());
}

/// All requests that an engine hands out now; they are owed then.
std::vector<Request> requests_of(Synthesizer& engine) {
  std::vector<Request> requests(1000);
  requests.resize(engine.request(requests));
  std::sort(requests.begin(), requests.end(),
            [](const Request& a, const Request& b) { return a.id < b.id; });
  return requests;
}

void expect_same(const std::vector<Request>& some, const std::vector<Request>& others) {
  ASSERT_EQ(some.size(), others.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    const Request &a = some[i], &b = others[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.x), std::bit_cast<std::uint64_t>(b.x));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.y), std::bit_cast<std::uint64_t>(b.y));
    EXPECT_EQ(a.spacing, b.spacing);
    EXPECT_EQ(a.slot, b.slot);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_EQ(a.ordinal, b.ordinal);
    EXPECT_EQ(a.again, b.again);
  }
}

/// Goes on with what is loaded from what an engine saves.
void save_and_load(std::unique_ptr<Synthesizer>& engine) {
  const Bytes bytes = engine->save();
  const SynthesisSettings settings = engine->settings();
  auto loaded = std::make_unique<Synthesizer>(settings, bytes);
  expect_same(*engine, *loaded);
  engine = std::move(loaded);
}

TEST(SavedSynthesis, EveryWaveGoesOnAsIfNothingHadHappened) {
  for (const std::size_t wave : std::array<std::size_t, 3>{1, 3, 0}) {
    for (const Noise noise : {Noise::none, Noise::automatic, Noise::present}) {
      RandomSynthesis synthesis(17);
      synthesis.settings = helpers::settings_of(27, 18, 2, wave);
      synthesis.settings.noise = noise;
      synthesis.settings.max_samples_per_block = 1000;
      synthesis.stop.samples = wave == 1 ? 300 : 900;
      synthesis.noise = noise == Noise::none ? 0 : 0.2f;
      auto saved = std::make_unique<Synthesizer>(synthesis.settings);
      Synthesizer twin(synthesis.settings);
      saved->set_stop(synthesis.stop);
      twin.set_stop(synthesis.stop);
      RandomHost host(synthesis, 1);
      for (;;) {
        save_and_load(saved);
        const std::vector<Request> requests = requests_of(*saved);
        expect_same(requests, requests_of(twin));
        if (requests.empty()) break;
        host.deliver(*saved, requests);
        host.deliver(twin, requests);
      }
      EXPECT_EQ(twin.stats().samples, synthesis.stop.samples);
      EXPECT_EQ(saved->save(), twin.save());
      EXPECT_EQ(saved->finished_image().save(), twin.finished_image().save());
    }
  }
}

class SavedRandomSynthesis : public testing::TestWithParam<unsigned> {};

TEST_P(SavedRandomSynthesis, IsItsUninterruptedTwin) {
  for (unsigned number = 80 * GetParam(); number < 80 * GetParam() + 80; ++number) {
    SCOPED_TRACE(number);
    const RandomSynthesis synthesis(number);
    Synthesizer twin(synthesis.settings);
    auto saved = std::make_unique<Synthesizer>(synthesis.settings);
    twin.set_stop(synthesis.stop);
    saved->set_stop(synthesis.stop);
    RandomHost(synthesis, 1).run(twin);
    RandomHost host(synthesis, 2);
    std::mt19937 random(number);
    int times = 0;
    while (host.step(*saved)) {
      if (random() % 16 != 0 || ++times > 20) continue;
      const std::vector<Request> owed = host.held();
      save_and_load(saved);
      host.held().clear();
      // What was owed is not owed any more, and comes again as it was.
      if (owed.empty()) continue;
      EXPECT_THROW(saved->give_back(owed), std::invalid_argument);
      host.held() = requests_of(*saved);
      for (const Request& one : owed) {
        const auto at = std::find_if(host.held().begin(), host.held().end(),
                                     [&](const Request& other) { return other.id == one.id; });
        ASSERT_NE(at, host.held().end());
        expect_same({one}, {*at});
      }
    }
    EXPECT_EQ(twin.stopped(), saved->stopped());
    expect_same(*saved, twin);
    EXPECT_EQ(saved->finished_image().save(), twin.finished_image().save());
    // And afterwards, under another rule.
    twin.set_stop({});
    saved->set_stop({});
    save_and_load(saved);
    expect_same(requests_of(*saved), requests_of(twin));
  }
}

INSTANTIATE_TEST_SUITE_P(Numbers, SavedRandomSynthesis, testing::Range(0u, 10u));

TEST(SavedSynthesis, GoesOnWithTheStopRuleThatWasSet) {
  Synthesizer engine(helpers::settings_of(20, 20, 1, 8));
  engine.set_stop(helpers::at_samples(3));
  Synthesizer loaded(engine.settings(), engine.save());
  const std::vector<Request> requests = requests_of(loaded);
  EXPECT_EQ(std::count_if(requests.begin(), requests.end(),
                          [](const Request& one) { return !one.again; }),
            3);
}

TEST(SavedSynthesis, GoesOnWithTheTimeThatWasSet) {
  Synthesizer engine(helpers::settings_of(20, 20));
  engine.set_stop({.seconds = 0});
  Synthesizer loaded(engine.settings(), engine.save());
  EXPECT_EQ(loaded.stopped(), StopReason::seconds);
}

/// A sampler without a usable value is not asked for ever.
TEST(SavedSynthesis, IsAsPatientAsItsTwin) {
  Synthesizer twin(helpers::settings_of(20, 20));
  auto saved = std::make_unique<Synthesizer>(twin.settings());
  const auto next = [](Synthesizer& engine) {
    const std::vector<Request> requests = requests_of(engine);
    const std::vector<float> nothing(requests.size(), std::numeric_limits<float>::quiet_NaN());
    engine.deliver(requests, nothing);
    return !requests.empty();
  };
  for (int wave = 0; wave < 30; ++wave) {
    next(twin);
    next(*saved);
  }
  twin.set_stop({});  // as many samples more
  saved->set_stop({});
  while (next(twin)) {
    save_and_load(saved);
    ASSERT_TRUE(next(*saved));
  }
  EXPECT_EQ(saved->stopped(), StopReason::unusable);
  EXPECT_EQ(saved->stats().samples, twin.stats().samples);
}

TEST(SavedSynthesis, GoesOnWithTheImportanceThatWasSet) {
  RandomSynthesis synthesis(17);
  synthesis.settings = helpers::settings_of(27, 18, 2, 5);
  Synthesizer twin(synthesis.settings);
  RandomHost host(synthesis, 1);
  const auto next = [&](Synthesizer& engine) { host.deliver(engine, requests_of(engine)); };
  for (int wave = 0; wave < 20; ++wave) next(twin);
  std::vector<float> importance(12, 0.01f);
  importance[7] = 3;
  const std::vector<Request> under_way = requests_of(twin);
  twin.set_importance(importance);  // from the next wave on
  Synthesizer saved(synthesis.settings, twin.save());
  expect_same(under_way, requests_of(saved));
  host.deliver(twin, under_way);
  host.deliver(saved, under_way);
  for (int wave = 0; wave < 10; ++wave) next(twin);
  for (int wave = 0; wave < 5; ++wave) next(saved);
  Synthesizer again(synthesis.settings, saved.save());
  for (int wave = 0; wave < 5; ++wave) next(again);
  expect_same(twin, again);
  EXPECT_EQ(twin.save(), again.save());
}

TEST(SavedSynthesis, SeveralThreadsMaySampleMeanwhile) {
  const SynthesisSettings settings = helpers::settings_of(40, 40, 1, 20);
  const StopRule stop = helpers::at_samples(3000);
  Synthesizer undisturbed(settings);
  undisturbed.run(helpers::picture, stop);
  Synthesizer engine(settings);
  engine.set_stop(stop);
  ThreadPool pool(3);
  std::vector<Bytes> saved;
  const auto task = [&](std::size_t index) {
    if (index == 0) {
      do {
        saved.push_back(engine.save());
      } while (engine.stats().samples < stop.samples);
    } else {
      engine.run(helpers::picture, stop, SerialExecutor(), KeepGoing(), 7);
    }
  };
  pool.execute(3, TaskRef(task));
  // What one thread was left waiting for by the other.
  engine.run(helpers::picture, stop);
  EXPECT_EQ(engine.image().save(), undisturbed.image().save());
  ASSERT_FALSE(saved.empty());
  for (std::size_t i = 0; i < saved.size(); i += 1 + saved.size() / 50) {
    Synthesizer loaded(settings, saved[i]);
    loaded.run(helpers::picture, stop);
    EXPECT_EQ(loaded.image().save(), undisturbed.image().save());
  }
}

/// Pixels of more samples than two bytes count.
TEST(SavedSynthesis, WideCountersAreSavedAsSuch) {
  const BlockGrid grid = BlockGrid::of(3, 2, 1);
  for (const bool wide : {false, true}) {
    PixelCounts counts(grid), loaded(grid);
    counts.reserve(wide ? 70000 : 60000);
    for (int i = 0; i < (wide ? 70000 : 60000); ++i) counts.next(4);
    Bytes bytes;
    const auto sink = [&](std::span<const std::byte> more) {
      bytes.insert(bytes.end(), more.begin(), more.end());
    };
    detail::StateWriter writer(sink, detail::synthesis_kind);
    writer.section("PIXL", [&] { StateArchive::pixels(writer, counts); });
    detail::StateReader reader(bytes, detail::synthesis_kind);
    reader.section("PIXL", [&] { StateArchive::pixels(reader, loaded); });
    // Those of two bytes have to know that they are nearly full.
    loaded.reserve(10000);
    counts.reserve(10000);
    for (const std::size_t pixel : {std::size_t{0}, std::size_t{4}, std::size_t{5}})
      EXPECT_EQ(loaded.next(pixel), counts.next(pixel));
    EXPECT_EQ(loaded.next(4), wide ? 70001u : 60001u);
  }
}

TEST(SavedSynthesis, ImagesWithoutBlocksDoToo) {
  Synthesizer engine(helpers::settings_of(0, 20));
  Synthesizer loaded(engine.settings(), engine.save());
  EXPECT_EQ(loaded.stopped(), engine.stopped());
}

}  // namespace
}  // namespace freqsynth
