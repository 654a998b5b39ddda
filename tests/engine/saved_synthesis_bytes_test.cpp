// SPDX-License-Identifier: MIT
// Bytes that are no saved engine, or not one of these settings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/basis/archive.h"
#include "freqsynth/engine/block_queue.h"
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

/// One that has met all that there is: bad samples, borders that wait, noise, a wave under way.
struct Busy {
  RandomSynthesis synthesis{3};
  std::unique_ptr<Synthesizer> engine;
  RandomHost host{synthesis, 1};

  Busy() {
    synthesis.settings = helpers::settings_of(12, 17, 3, 4);
    synthesis.settings.channel_settings = {
        {}, {.role = ChannelRole::nearest}, {.role = ChannelRole::mean}};
    synthesis.settings.shared_list = SharedInverseList(InverseListSettings());
    synthesis.settings.max_samples_per_block = 200;
    synthesis.noise = 0.3f;
    synthesis.bad_of = 5;
    engine = std::make_unique<Synthesizer>(synthesis.settings);
    while (engine->stats().waves < 30) host.step(*engine);
    while (host.held().empty()) host.step(*engine);
  }
};

TEST(SavedSynthesisBytes, EveryTruncationAndEveryChangedByteIsRefused) {
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
TEST(SavedSynthesisBytes, OtherContentIsRefusedOrGoesOn) {
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

TEST(SavedSynthesisBytes, ABlockThatIsFullMayNotBeChosen) {
  SynthesisSettings settings = helpers::settings_of(12, 17);
  settings.max_samples_per_block = 9;
  Synthesizer engine(settings);
  engine.run(helpers::picture, {});
  Bytes bytes = engine.save();
  const float out = BlockQueue::absent, in = 1;
  const std::vector<float> priorities(6, out);
  std::array<std::byte, 24> wanted;
  detail::encode(std::span<const float>(priorities), wanted.data());
  const auto found = std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
  ASSERT_NE(found, bytes.end());
  detail::encode(std::span<const float>(&in, 1), &*found);
  EXPECT_THAT(
      [&] { Synthesizer(settings, testing_support::with_right_checks(bytes)); },
      ThrowsMessage<std::runtime_error>(HasSubstr("holds what it cannot, in section CHOI")));
}

TEST(SavedSynthesisBytes, OtherSettingsAreRefusedByName) {
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

TEST(SavedSynthesisBytes, IsTheSameFromAFile) {
  const std::string file =
      testing::TempDir() + "freqsynth_saved_" + std::to_string(std::random_device()());
  Busy busy;
  save_file(file, *busy.engine);
  Synthesizer loaded = load_synthesizer(file, busy.synthesis.settings);
  EXPECT_EQ(Synthesizer(busy.synthesis.settings, busy.engine->save()).save(), loaded.save());
  EXPECT_THAT([&] { static_cast<void>(load_synthesizer(file, helpers::settings_of(3, 3))); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(StartsWith("freqsynth: cannot read " + file),
                        HasSubstr("is of other settings: width was 12, and is 3"))));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace freqsynth
