// SPDX-License-Identifier: MIT
// Engines that are saved and loaded go on as if nothing had happened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "freqsynth/synthesizer_file.h"
#include "support/engine_helpers.h"
#include "support/handmade_archive.h"
#include "support/random_synthesis.h"

namespace freqsynth {
namespace {

using helpers::RandomHost;
using helpers::RandomSynthesis;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;
using testing_support::Bytes;

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
    if (roles[c].role != ChannelRole::nearest) continue;
    for (const float value : engine.nearest_pixels(c)) {
      numbers.push_back(std::bit_cast<std::uint32_t>(value));
    }
  }
  return numbers;
}

void expect_same(const Synthesizer& one, const Synthesizer& other) {
  EXPECT_EQ(numbers_of(one), numbers_of(other));
  EXPECT_EQ(one.image().save(), other.image().save());
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

TEST(SavedSynthesis, ImagesWithoutBlocksDoToo) {
  Synthesizer engine(helpers::settings_of(0, 20));
  Synthesizer loaded(engine.settings(), engine.save());
  EXPECT_EQ(loaded.stopped(), engine.stopped());
}

/// One that has met all that there is: bad samples, borders that wait, noise, a wave under way.
struct Busy {
  RandomSynthesis synthesis{3};
  std::unique_ptr<Synthesizer> engine;
  RandomHost host{synthesis, 1};

  Busy() {
    synthesis.settings = helpers::settings_of(12, 17, 2, 4);
    synthesis.settings.channel_settings = {{}, {.role = ChannelRole::nearest}};
    synthesis.settings.shared_list = SharedInverseList(InverseListSettings());
    synthesis.settings.max_samples_per_block = 200;
    synthesis.noise = 0.3f;
    synthesis.bad_of = 5;
    engine = std::make_unique<Synthesizer>(synthesis.settings);
    while (engine->stats().waves < 30) host.step(*engine);
    while (host.held().empty()) host.step(*engine);
  }
};

TEST(SavedSynthesis, EveryTruncationAndEveryChangedByteIsRefused) {
  Busy busy;
  const Bytes good = busy.engine->save();
  EXPECT_EQ(Synthesizer(busy.synthesis.settings, good).stats().samples,
            busy.engine->stats().samples);
  for (std::size_t at = 0; at < good.size(); ++at) {
    const auto end = good.begin() + static_cast<std::ptrdiff_t>(at);
    EXPECT_THROW(Synthesizer(busy.synthesis.settings, Bytes(good.begin(), end)),
                 std::runtime_error);
    Bytes bytes = good;
    bytes[at] ^= static_cast<std::byte>(1 + at % 255);
    EXPECT_THROW(Synthesizer(busy.synthesis.settings, bytes), std::runtime_error);
  }
}

/// Whoever makes the check values fit may get an engine with other numbers, but one that works.
TEST(SavedSynthesis, OtherContentIsRefusedOrGoesOn) {
  Busy busy;
  const Bytes good = busy.engine->save();
  const std::size_t blocks = 6;
  std::mt19937 random(1);
  int refused = 0, loaded = 0;
  for (int i = 0; i < 1000; ++i) {
    Bytes bytes = good;
    for (auto n = random() % 3 + 1; n > 0; --n) {
      bytes[16 + random() % (bytes.size() - 16)] = static_cast<std::byte>(random() & 0xffu);
    }
    bytes = testing_support::with_right_checks(bytes);
    std::optional<Synthesizer> engine;
    try {
      engine.emplace(busy.synthesis.settings, bytes);
    } catch (const std::runtime_error&) {
      ++refused;
      continue;
    }
    ++loaded;
    engine->set_stop({});
    RandomHost host(busy.synthesis, 2);
    for (int step = 0; step < 20; ++step) host.step(*engine);
    EXPECT_EQ(engine->image().blocks_x() * engine->image().blocks_y(), blocks);
    static_cast<void>(engine->finished_image());
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(loaded, 100);
}

TEST(SavedSynthesis, OtherSettingsAreRefusedByName) {
  SynthesisSettings settings = helpers::settings_of(20, 12, 2, 8);
  settings.importance.assign(6, 1.0f);
  const Bytes bytes = Synthesizer(settings).save();
  const auto refused = [&](const auto& change, const std::string& what) {
    SynthesisSettings others = settings;
    change(others);
    EXPECT_THAT([&] { Synthesizer(others, bytes); },
                ThrowsMessage<std::runtime_error>(
                    "freqsynth: saved synthesis is of other settings: " + what));
  };
  using S = SynthesisSettings;
  refused([](S& s) { s.width = 21; }, "width was 20, and is 21");
  refused([](S& s) { s.channels = 3; }, "channels was 2, and is 3");
  refused([](S& s) { s.noise = Noise::none; }, "noise was 0, and is 1");
  refused([](S& s) { s.seed = 4; }, "seed was 0, and is 4");
  refused([](S& s) { s.list.seed = 5; }, "list.seed was 0, and is 5");
  refused([](S& s) { s.list.positions = SamplePositions::lattice; },
          "list.positions was 0, and is 1");
  refused([](S& s) { s.priority.decay = 0.5; }, "priority.decay was 0.7165, and is 0.5");
  refused([](S& s) { s.priority.steer = Steer::display; }, "priority.steer was 0, and is 2");
  refused([](S& s) { s.wave = 9; }, "wave was 8, and is 9");
  refused([](S& s) { s.max_samples_per_block = 9; }, "max_samples_per_block was 66049, and is 9");
  refused(
      [](S& s) {
        s.channel_settings = {{}, {.role = ChannelRole::passive}};
      },
      "channel_settings[1].role was 0, and is 1");
  refused([](S& s) { s.window = {1, 2, 5, 6}; }, "window.x was 0, and is 1");
  refused([](S& s) { s.importance.clear(); }, "the number of importance was 6, and is 0");
  refused([](S& s) { s.importance[3] = 2; }, "importance was 1, and is 2");
  std::array<float, max_terms> steps;
  steps.fill(1);
  refused(
      [&](S& s) {
        s.quantization = {.steps = {steps, steps}};
      },
      "quantization was 0, and is 1");
  // What says the same in other words is the same.
  SynthesisSettings same = settings;
  same.channel_settings.resize(2);
  same.shared_list = SharedInverseList(same.list);
  same.list.seed = 7;  // which is not read then
  EXPECT_NO_THROW(Synthesizer(same, bytes));
}

TEST(SavedSynthesis, IsTheSameFromAFile) {
  const std::string file =
      testing::TempDir() + "freqsynth_saved_" + std::to_string(std::random_device()());
  Busy busy;
  save_file(file, *busy.engine);
  Synthesizer loaded = load_synthesizer(file, busy.synthesis.settings);
  expect_same(loaded, *busy.engine);
  EXPECT_THAT([&] { static_cast<void>(load_synthesizer(file, helpers::settings_of(3, 3))); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(StartsWith("freqsynth: cannot read " + file),
                        HasSubstr("is of other settings: width was 12, and is 3"))));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace freqsynth
