// SPDX-License-Identifier: MIT
// Memory that runs out while an engine is saved or loaded, and answers to one that was loaded.
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "faults/failing_new.h"
#include "freqsynth/freqsynth.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::picture;

/// In the middle of a wave, half of which is owed.
std::unique_ptr<Synthesizer> half_way() {
  auto engine = std::make_unique<Synthesizer>(helpers::settings_of(48, 40, 1, 8));
  engine->run(picture, helpers::at_samples(300));
  engine->set_stop({});
  std::vector<Request> requests(5);
  requests.resize(engine->request(requests));
  const std::vector<float> values(2, 0.5f);
  engine->deliver(std::span(requests).first(2), values);
  return engine;
}

TEST(SavedAllocation, AnEngineIsLoadedOrNot) {
  const std::unique_ptr<Synthesizer> engine = half_way();
  const std::vector<std::byte> bytes = engine->save();
  SynthesisSettings settings = helpers::settings_of(48, 40, 1, 8);
  settings.shared_list = engine->settings().shared_list;
  // The list, which others share, stays as long as the next wave needs it.
  { const Synthesizer first(settings, bytes); }
  for (std::size_t k = 0;; ++k) {
    const std::size_t before = faults::bytes_in_use();
    const faults::FailAllocation fault(k);
    bool loaded = false;
    try {
      const Synthesizer again(settings, bytes);
      loaded = again.stats().samples == 302;
    } catch (const std::bad_alloc&) {
      EXPECT_TRUE(fault.failed());
    }
    EXPECT_EQ(faults::bytes_in_use(), before) << "nothing is left behind, at " << k;
    EXPECT_EQ(loaded, !fault.failed()) << k;
    if (loaded) break;
  }
}

TEST(SavedAllocation, AnEngineIsSavedOrNot) {
  const std::unique_ptr<Synthesizer> engine = half_way();
  const std::vector<std::byte> bytes = engine->save();
  for (std::size_t k = 0;; ++k) {
    const faults::FailAllocation fault(k);
    try {
      EXPECT_EQ(engine->save(), bytes);
      break;
    } catch (const std::bad_alloc&) {
      ASSERT_TRUE(fault.failed());
    }
  }
  EXPECT_EQ(engine->save(), bytes);
}

/// What a wave needs is taken when it is loaded, as it is when it is chosen.
TEST(SavedAllocation, AnswersToWhatWasLoadedNeedNoMemory) {
  const std::unique_ptr<Synthesizer> engine = half_way();
  Synthesizer loaded(engine->settings(), engine->save());
  std::vector<Request> requests(100);
  requests.resize(loaded.request(requests));
  ASSERT_GT(requests.size(), 1u);
  const std::vector<float> values(requests.size(), 0.5f);
  const std::size_t waves = loaded.stats().waves;
  const std::size_t before = faults::allocations();
  loaded.give_back(std::span(requests).first(1));
  loaded.deliver(std::span(requests).subspan(1), std::span(values).subspan(1));
  EXPECT_EQ(faults::allocations(), before);
  ASSERT_EQ(loaded.request(std::span(requests).first(1)), 1u);
  const std::size_t last = faults::allocations();
  loaded.deliver(std::span(requests).first(1), std::span(values).first(1));
  EXPECT_EQ(faults::allocations(), last);
  EXPECT_EQ(loaded.stats().waves, waves + 1);
}

}  // namespace
}  // namespace freqsynth
