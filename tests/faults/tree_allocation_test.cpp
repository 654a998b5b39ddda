// SPDX-License-Identifier: MIT
// Memory that runs out while an engine of a tree takes in a wave: nothing that was sampled is lost,
// and what comes of it is what comes of work without a fault.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "faults/failing_new.h"
#include "faults/survive.h"
#include "freqsynth/freqsynth.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using faults::loop;
using faults::survive;
using helpers::at_samples;
using helpers::picture;

SynthesisSettings tree_settings(Steer steer = Steer::linear) {
  SynthesisSettings settings = helpers::settings_of(24, 16);
  settings.refiner = RefinerKind::kriging;
  settings.priority.steer = steer;
  return settings;
}

/// Enough that nodes are split, and quadrants of these.
constexpr std::uint64_t budget = 5000;

/// What the host has by the end of a loop in which allocation `k` fails.
struct Outcome {
  std::unique_ptr<Synthesizer> engine;
  std::uint64_t answered = 0;
  bool failed = false;
};

Outcome outcome(const SynthesisSettings& settings, std::size_t k) {
  Outcome outcome{std::make_unique<Synthesizer>(settings)};
  outcome.engine->set_stop(at_samples(budget));
  std::vector<Request> requests;
  requests.reserve(7);
  std::vector<float> values(1);
  outcome.failed = survive(k, [&] { loop(*outcome.engine, outcome.answered, requests, values); });
  return outcome;
}

void expect_same(const Outcome& one, const Outcome& straight, std::size_t k) {
  ASSERT_EQ(one.answered, straight.answered) << k;
  ASSERT_EQ(one.engine->stats().samples, budget) << k;
  ASSERT_EQ(one.engine->stats().absorbed, straight.engine->stats().absorbed) << k;
  ASSERT_EQ(one.engine->save(), straight.engine->save()) << k;
}

TEST(TreeAllocation, AnEngineGoesOn) {
  constexpr std::size_t never = 1u << 30;
  for (const Steer steer : {Steer::linear, Steer::relative}) {
    // Lists are shared with it, and there already.
    const Outcome straight = outcome(tree_settings(steer), never);
    std::size_t faults = 0;
    for (std::size_t k = 0;; ++k) {
      const Outcome one = outcome(tree_settings(steer), k);
      expect_same(one, straight, k);
      if (HasFatalFailure()) return;
      if (!one.failed) break;
      ++faults;
    }
    EXPECT_GT(faults, 50u);
  }
}

TEST(TreeAllocation, AnEngineWhoseListsGrowGoesOn) {
  const std::size_t before = faults::allocations();
  const std::vector<std::byte> straight = outcome(tree_settings(), 1u << 30).engine->save();
  const std::size_t all = faults::allocations() - before;
  std::size_t faults = 0;
  // One in many: each builds its lists anew.
  for (std::size_t k = 0; k < all; k += all / 40 + 1) {
    const Outcome one = outcome(tree_settings(), k);
    ASSERT_EQ(one.engine->save(), straight) << k;
    faults += one.failed ? 1 : 0;
  }
  EXPECT_GT(faults, 20u);
}

/// The value that completes a wave is taken, whatever comes of the wave.
TEST(TreeAllocation, AnswersNeedNoMemory) {
  const auto answer = [](Synthesizer& engine, bool fault) {
    engine.set_stop(at_samples(budget));
    std::vector<Request> requests(256);
    std::vector<float> values(256);
    std::size_t failed = 0, k = 0;
    for (;;) {
      std::size_t count = 0;
      try {
        count = engine.request(requests);
      } catch (const std::bad_alloc&) {
        ADD_FAILURE() << "there is memory again";
      }
      if (count == 0) return failed;
      for (std::size_t i = 0; i < count; ++i) values[i] = picture(requests[i].x, requests[i].y);
      const faults::FailAllocation next(fault ? k++ % 5 : 1u << 30);
      EXPECT_NO_THROW(
          engine.deliver(std::span(requests).first(count), std::span(values).first(count)));
      failed += next.failed() ? 1 : 0;
    }
  };
  Synthesizer straight(tree_settings()), engine(tree_settings());
  EXPECT_EQ(answer(straight, false), 0u);
  EXPECT_GT(answer(engine, true), 5u);
  EXPECT_EQ(engine.save(), straight.save());
}

}  // namespace
}  // namespace freqsynth
