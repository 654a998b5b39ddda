// SPDX-License-Identifier: MIT
#include "freqsynth/engine/wave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using Values = std::vector<float>;

/// What a wave is, told by sets: every slot is in one of them.
struct Model {
  std::set<std::uint32_t> fresh, returned, owed, claimed;
  std::map<std::uint32_t, Values> delivered;

  [[nodiscard]] std::size_t size() const {
    return fresh.size() + returned.size() + owed.size() + claimed.size() + delivered.size();
  }
};

void expect_same(const Wave& wave, const Model& model) {
  ASSERT_EQ(wave.size(), model.size());
  ASSERT_EQ(wave.empty(), model.size() == 0);
  ASSERT_EQ(wave.waiting(), !model.fresh.empty() || !model.returned.empty());
  ASSERT_EQ(wave.delivered(), model.delivered.size());
  ASSERT_EQ(wave.complete(), model.size() > 0 && model.delivered.size() == model.size());
  // Slots beyond the end are no one's.
  for (std::uint32_t slot = 0; slot < wave.size() + 3; ++slot) {
    ASSERT_EQ(wave.owed(slot), model.owed.contains(slot)) << "slot " << slot;
  }
}

std::optional<std::uint32_t> any_of(const std::set<std::uint32_t>& slots, oracle::Random& random) {
  if (slots.empty()) return std::nullopt;
  return *std::next(slots.begin(), static_cast<std::ptrdiff_t>(random.below(slots.size())));
}

/// One thing that may happen to a wave.
void step(Wave& wave, Model& model, std::size_t channels, oracle::Random& random) {
  const auto owed = any_of(model.owed, random);
  const auto claimed = any_of(model.claimed, random);
  switch (random.below(5)) {
    case 0:
    case 1:
      if (wave.waiting()) {
        const std::uint32_t slot = wave.hand_out();
        // What came back goes out before what never was.
        if (!model.returned.empty()) {
          ASSERT_EQ(model.returned.erase(slot), 1u);
        } else {
          ASSERT_EQ(slot, *model.fresh.begin()) << "in the order in which they were added";
          model.fresh.erase(slot);
        }
        model.owed.insert(slot);
      }
      break;
    case 2:
      if (owed) {
        wave.claim(*owed);
        model.owed.erase(*owed);
        model.claimed.insert(*owed);
      }
      break;
    case 3:
      if (claimed) {
        Values values;
        for (std::size_t c = 0; c < channels; ++c) values.push_back(random.value());
        wave.deliver(*claimed, values.data());
        model.claimed.erase(*claimed);
        model.delivered[*claimed] = values;
      }
      break;
    default:
      if (claimed) {
        model.claimed.erase(*claimed);
        if (random.below(2) == 0) {
          wave.let_go(*claimed);
          model.owed.insert(*claimed);
        } else {
          wave.recall(*claimed);
          model.returned.insert(*claimed);
        }
      }
  }
}

class Waves : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Channels, Waves, testing::Values(1, 3, 17));

TEST_P(Waves, FollowSetsThroughRandomHistories) {
  const std::size_t channels = GetParam();
  constexpr std::size_t most = 24;
  oracle::Random random(static_cast<unsigned>(channels));
  Wave wave(channels);
  wave.reserve(most);
  std::size_t completed = 0;
  for (int repetition = 0; repetition < 40; ++repetition) {
    Model model;
    ASSERT_NO_FATAL_FAILURE(expect_same(wave, model)) << "a cleared wave is like a new one";
    std::vector<Wave::Slot> slots(1 + random.below(most));
    for (std::uint32_t slot = 0; slot < slots.size(); ++slot) {
      slots[slot] = {static_cast<std::uint32_t>(random.below(1000)),
                     static_cast<std::uint32_t>(random.below(1000))};
      wave.add(slots[slot]);
      model.fresh.insert(slot);
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(wave, model));
    // Some waves are given up while slots of all kinds are there.
    const bool gives_up = repetition % 4 == 3;
    while (!wave.complete()) {
      if (gives_up && !model.returned.empty() && !model.owed.empty()) break;
      ASSERT_NO_FATAL_FAILURE(step(wave, model, channels, random));
      ASSERT_NO_FATAL_FAILURE(expect_same(wave, model));
    }
    completed += wave.complete() ? 1 : 0;
    for (std::uint32_t slot = 0; slot < slots.size(); ++slot) {
      ASSERT_EQ(wave.slot(slot).block, slots[slot].block);
      ASSERT_EQ(wave.slot(slot).index, slots[slot].index);
    }
    for (const auto& [slot, values] : model.delivered) {
      ASSERT_EQ(Values(wave.values(slot), wave.values(slot) + channels), values);
    }
    wave.clear();
  }
  EXPECT_GE(completed, 30u);
  EXPECT_LT(completed, 40u);
}

TEST(Wave, IsHandedOutInOrderOnce) {
  Wave wave(1);
  wave.reserve(5);
  for (std::uint32_t slot = 0; slot < 5; ++slot) wave.add({slot, 7});
  for (std::uint32_t slot = 0; slot < 5; ++slot) EXPECT_EQ(wave.hand_out(), slot);
  EXPECT_FALSE(wave.waiting());
}

TEST(Wave, WhatCameBackGoesOutFirst) {
  Wave wave(1);
  wave.reserve(4);
  for (std::uint32_t slot = 0; slot < 4; ++slot) wave.add({slot, 0});
  const std::uint32_t first = wave.hand_out(), second = wave.hand_out();
  for (const std::uint32_t slot : {first, second}) {
    wave.claim(slot);
    wave.recall(slot);
  }
  std::vector<std::uint32_t> again = {wave.hand_out(), wave.hand_out()};
  std::sort(again.begin(), again.end());
  EXPECT_EQ(again, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(wave.hand_out(), 2u);
}

TEST(Wave, RepeatedSlotsComeLastAndAreNoSamples) {
  Wave wave(2, 1);
  for (int repetition = 0; repetition < 2; ++repetition) {
    wave.reserve(5);
    for (std::uint32_t slot = 0; slot < 3; ++slot) wave.add({10 + slot, 20 + slot});
    wave.repeat(2);
    wave.repeat(0);
    EXPECT_EQ(wave.samples(), 3u);
    EXPECT_EQ(wave.size(), 5u);
    EXPECT_EQ(wave.values().size(), 6u);
    for (std::uint32_t slot = 0; slot < 5; ++slot) {
      const std::uint32_t place = slot == 3 ? 2 : slot == 4 ? 0 : slot;
      EXPECT_EQ(wave.slot(slot).block, 10 + place);
      EXPECT_EQ(wave.slot(slot).index, 20 + place);
      EXPECT_EQ(wave.slot(slot).repeated, slot < 3 ? Wave::Slot::none : place);
      EXPECT_EQ(wave.hand_out(), slot);
    }
    std::size_t samples = 0, all = 0;
    for (const std::uint32_t slot : {4u, 1u, 0u, 3u, 2u}) {
      EXPECT_FALSE(wave.complete());
      const float values[] = {static_cast<float>(slot), 7, -static_cast<float>(slot)};
      wave.claim(slot);
      wave.deliver(slot, values);
      samples += slot < 3 ? 1 : 0;
      EXPECT_EQ(wave.delivered(), ++all);
      EXPECT_EQ(wave.delivered_samples(), samples);
    }
    EXPECT_TRUE(wave.complete());
    for (std::uint32_t slot = 0; slot < 5; ++slot) {
      EXPECT_EQ(wave.values(slot)[0], static_cast<float>(slot));
      EXPECT_EQ(wave.values(slot)[1], 7);
      EXPECT_EQ(wave.apart(slot)[0], -static_cast<float>(slot));
    }
    wave.clear();
    EXPECT_EQ(wave.samples() + wave.size() + wave.delivered() + wave.delivered_samples(), 0u);
  }
}

TEST(Wave, AnEmptyWaveIsNotComplete) {
  Wave wave(2);
  EXPECT_FALSE(wave.complete());
  EXPECT_FALSE(wave.waiting());
  EXPECT_FALSE(wave.owed(0));
}

TEST(Wave, MemoryStaysWhereItWasReserved) {
  constexpr std::size_t channels = 3, most = 50;
  Wave wave(channels);
  wave.reserve(most);
  wave.add({});
  const Wave::Slot* const slots = &wave.slot(0);
  const float* const values = wave.values(0);
  wave.clear();
  for (const std::size_t size : {most, std::size_t{3}, most}) {
    wave.reserve(size);  // a smaller wave gives nothing back
    for (std::uint32_t slot = 0; slot < size; ++slot) wave.add({slot, 0});
    const Values some(channels, 1);
    for (std::size_t slot = 0; slot < size; ++slot) wave.claim(wave.hand_out());
    for (std::uint32_t slot = 0; slot < size; ++slot) wave.recall(slot);
    while (wave.waiting()) {
      const std::uint32_t slot = wave.hand_out();
      wave.claim(slot);
      wave.deliver(slot, some.data());
    }
    EXPECT_TRUE(wave.complete());
    EXPECT_EQ(&wave.slot(0), slots);
    EXPECT_EQ(wave.values(0), values);
    wave.clear();
  }
}

TEST(Wave, KeepsWhatWasKnownBefore) {
  Wave wave(2);
  for (int repetition = 0; repetition < 3; ++repetition) {
    wave.reserve(1, 5);
    for (std::uint32_t i = 0; i < 5; ++i) {
      const std::array values{static_cast<float>(i), -static_cast<float>(i)};
      wave.keep_known(values.data());
    }
    for (std::uint32_t i = 0; i < 5; ++i) {
      EXPECT_EQ(wave.known(i)[0], static_cast<float>(i));
      EXPECT_EQ(wave.known(i)[1], -static_cast<float>(i));
    }
    wave.clear();
  }
}

}  // namespace
}  // namespace freqsynth
