// SPDX-License-Identifier: MIT
// Syntheses by a tree of nodes that are saved and loaded go on as if nothing had happened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/handmade_archive.h"
#include "support/kriging_helpers.h"

namespace freqsynth {
namespace {

using helpers::kriging_of;
using helpers::random_kriging;
using helpers::RandomHost;
using helpers::RandomSynthesis;
using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::Bytes;

/// Goes on with what is loaded from what an engine saves.
void save_and_load(std::unique_ptr<Synthesizer>& engine) {
  const Bytes bytes = engine->save();
  auto loaded = std::make_unique<Synthesizer>(engine->settings(), bytes);
  EXPECT_EQ(loaded->image().save(), engine->image().save());
  // But for what was owed, which is not any more, it is the same; then nothing is owed.
  EXPECT_EQ(Synthesizer(engine->settings(), loaded->save()).save(), loaded->save());
  engine = std::move(loaded);
}

class SavedKriging : public testing::TestWithParam<unsigned> {};

TEST_P(SavedKriging, IsItsUninterruptedTwin) {
  for (unsigned number = 5 * GetParam(); number < 5 * GetParam() + 3; ++number) {
    SCOPED_TRACE(number);
    const RandomSynthesis synthesis = random_kriging(number);
    Synthesizer twin(synthesis.settings);
    auto saved = std::make_unique<Synthesizer>(synthesis.settings);
    twin.set_stop(synthesis.stop);
    saved->set_stop(synthesis.stop);
    RandomHost(synthesis, 1).run(twin);
    RandomHost host(synthesis, 2);
    std::mt19937 random(number);
    int times = 0;
    while (host.step(*saved)) {
      if (random() % 16 != 0 || ++times > 6) continue;
      const std::vector<Request> owed = host.held();
      save_and_load(saved);
      host.held().clear();
      // What was owed is not owed any more, and comes again as it was.
      if (owed.empty()) continue;
      EXPECT_THROW(saved->give_back(owed), std::invalid_argument);
      std::vector<Request>& again = host.held();
      again.resize(4000);
      again.resize(saved->request(again));
      for (const Request& one : owed) {
        const auto at = std::find_if(again.begin(), again.end(),
                                     [&](const Request& other) { return other.id == one.id; });
        ASSERT_NE(at, again.end());
        EXPECT_EQ(at->x, one.x);
        EXPECT_EQ(at->y, one.y);
        EXPECT_EQ(at->spacing, one.spacing);
        EXPECT_EQ(at->seed, one.seed);
        EXPECT_EQ(at->pixel, one.pixel);
        EXPECT_EQ(at->ordinal, one.ordinal);
        EXPECT_EQ(at->again, one.again);
      }
    }
    EXPECT_EQ(twin.stopped(), saved->stopped());
    EXPECT_EQ(twin.save(), saved->save());
    if (number % 8 == 0) {
      EXPECT_EQ(twin.finished_image().save(), saved->finished_image().save());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Numbers, SavedKriging, testing::Range(0u, 6u));

/// One whose blocks are split and whose wave is under way.
struct Busy {
  RandomSynthesis synthesis = random_kriging(3);
  std::unique_ptr<Synthesizer> engine;
  RandomHost host{synthesis, 1};

  Busy() {
    synthesis.settings = kriging_of(12, 17, 2);
    synthesis.settings.channel_settings = {{}, {.role = ChannelRole::nearest}};
    synthesis.noise = 0.3f;
    synthesis.bad_of = 5;
    engine = std::make_unique<Synthesizer>(synthesis.settings);
    while (engine->stats().samples < 500) host.step(*engine);
    while (host.held().empty()) host.step(*engine);
  }
};

TEST(SavedKrigingBytes, TruncationsAndChangedBytesAreRefused) {
  const Busy busy;
  const Bytes good = busy.engine->save();
  EXPECT_EQ(Synthesizer(busy.synthesis.settings, good).stats().samples,
            busy.engine->stats().samples);
  for (std::size_t at = 0; at < good.size(); at += 1 + at / 20) {
    const auto end = good.begin() + static_cast<std::ptrdiff_t>(at);
    EXPECT_THROW(Synthesizer(busy.synthesis.settings, Bytes(good.begin(), end)),
                 std::runtime_error);
    Bytes bytes = good;
    bytes[at] ^= static_cast<std::byte>(1 + at % 255);
    EXPECT_THROW(Synthesizer(busy.synthesis.settings, bytes), std::runtime_error);
  }
}

/// Whoever makes the check values fit may get an engine with other numbers, but one that works.
TEST(SavedKrigingBytes, OtherContentIsRefusedOrGoesOn) {
  const Busy busy;
  const Bytes good = busy.engine->save();
  std::mt19937 random(1);
  int refused = 0, loaded = 0;
  for (int i = 0; i < 100; ++i) {
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
    EXPECT_EQ(engine->image().blocks_x(), 2u);
    EXPECT_EQ(Synthesizer(engine->settings(), engine->save()).stats().samples,
              engine->stats().samples);
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(loaded, 10);
}

TEST(SavedKrigingBytes, OfTheOtherRefinerOrOtherSettingsAreRefused) {
  const SynthesisSettings settings = kriging_of(20, 12, 2);
  const Bytes bytes = Synthesizer(settings).save();
  SynthesisSettings blocks = settings;
  blocks.refiner = RefinerKind::least_squares;
  EXPECT_THROW(Synthesizer(blocks, bytes), std::runtime_error);
  EXPECT_THROW(Synthesizer(settings, Synthesizer(blocks).save()), std::runtime_error);
  SynthesisSettings others = settings;
  others.list.seed = 5;
  EXPECT_THAT([&] { Synthesizer(others, bytes); },
              ThrowsMessage<std::runtime_error>(
                  HasSubstr("is of other settings: list.seed was 0, and is 5")));
}

}  // namespace
}  // namespace freqsynth
