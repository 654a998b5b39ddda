// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_snapshot.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "freqsynth/engine/state_keeper.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using helpers::ScriptedRefiner;

TEST(StateKeeper, ReadsWhatWasThereBeforeChangesInAnyOrder) {
  constexpr std::size_t blocks = 50, floats = 16;
  oracle::Random random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<float> states(blocks * floats);
    for (float& value : states) value = random.value();
    const std::vector<float> before = states;
    detail::StateKeeper keeper(blocks, floats);
    std::vector<unsigned> left(blocks, 3);
    for (std::size_t reads = 3 * blocks; reads > 0;) {
      const std::size_t block = random.below(blocks);
      float* state = states.data() + block * floats;
      if (random.below(2) == 0) {
        keeper.keep(block, state);
        for (std::size_t i = 0; i < floats; ++i) state[i] += 1;
      } else if (left[block] > 0) {
        std::array<float, floats> read;
        keeper.read(block, state, read.data(), 3);
        for (std::size_t i = 0; i < floats; ++i) {
          ASSERT_EQ(read[i], before[block * floats + i]) << "block " << block;
        }
        --left[block];
        --reads;
      }
    }
  }
}

TEST(StateKeeper, ThreadsReadAndChangeAtTheSameTime) {
  constexpr std::size_t blocks = 400, floats = 64;
  for (int round = 0; round < 20; ++round) {
    std::vector<float> states(blocks * floats);
    for (std::size_t i = 0; i < states.size(); ++i) states[i] = static_cast<float>(i / floats);
    detail::StateKeeper keeper(blocks, floats);
    std::atomic<int> ready = 0;
    std::atomic<std::size_t> wrong = 0;
    const auto start = [&] {
      for (++ready; ready < 3;) std::this_thread::yield();
    };
    const auto read_all = [&](std::size_t first) {
      start();
      std::array<float, floats> read;
      for (std::size_t i = 0; i < blocks; ++i) {
        const std::size_t block = (first + i) % blocks;
        keeper.read(block, states.data() + block * floats, read.data(), 2);
        for (const float value : read) wrong += value == static_cast<float>(block) ? 0 : 1;
      }
    };
    {
      std::jthread one(read_all, 0), other(read_all, blocks / 2);
      std::jthread writer([&] {
        start();
        for (std::size_t i = 0; i < 4 * blocks; ++i) {
          const std::size_t block = i * 7 % blocks;
          float* state = states.data() + block * floats;
          keeper.keep(block, state);
          for (std::size_t k = 0; k < floats; ++k) state[k] = -1;
        }
      });
    }
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(BlockSnapshot, StaysAsItIsWhileTheStoreGoesOn) {
  constexpr std::size_t blocks = 20;
  BlockStore<ScriptedRefiner> store(ScriptedRefiner({1}), blocks, 100);
  oracle::Random random(1);
  const auto absorb = [&](std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
      const float value = random.value();
      static_cast<void>(store.absorb(random.below(blocks), &value));
    }
  };
  absorb(100);
  const BlockStore<ScriptedRefiner> before = store;
  detail::StateKeeper keeper(blocks, store.state_size());
  const BlockSnapshot<ScriptedRefiner> snapshot(store, &keeper);
  store.watch(&keeper);
  std::vector<float> state(store.state_size());
  for (std::size_t b = 0; b < blocks; ++b) {
    absorb(10);
    // Other units change all states.
    const std::array<int, 1> exponent{static_cast<int>(b)};
    const std::array<float, 1> weight{1};
    if (b % 5 == 4) store.use_units(exponent, weight);
    snapshot.read(b, state.data());
    EXPECT_EQ(snapshot.samples(b), before.samples(b));
    EXPECT_EQ(snapshot.exponent(0), 0);
    for (std::size_t i = 0; i < state.size(); ++i) {
      ASSERT_EQ(state[i], before.state(b)[i]) << "block " << b;
    }
  }
  store.watch(nullptr);
}

/// Previews while another thread delivers: each is the picture after a number of whole waves.
TEST(BlockSnapshot, PreviewsWhileAThreadDeliversAreOfCompletedWaves) {
  const SynthesisSettings settings = helpers::settings_of(96, 64, 3);
  const auto scene = [](double x, double y) {
    const float value = helpers::picture(x, y);
    return std::array{value, 1 - value, value * value};
  };
  std::vector<FrequencyImage> fits, finished;
  {
    Synthesizer engine(settings);
    // The same rule: the last waves before it are smaller.
    engine.set_stop(helpers::at_samples(6000));
    std::vector<Request> requests(10000);
    for (std::uint64_t waves = 0;; ++waves) {
      ASSERT_EQ(engine.stats().waves, waves);
      fits.push_back(engine.image());
      finished.push_back(engine.finished_image());
      const std::size_t count = engine.request(requests);
      if (count == 0) break;
      std::vector<float> values;
      for (std::size_t i = 0; i < count; ++i) {
        for (const float value : scene(requests[i].x, requests[i].y)) values.push_back(value);
      }
      engine.deliver(std::span(requests).first(count), values);
    }
  }
  Synthesizer engine(settings);
  std::vector<FrequencyImage> seen, seen_finished;
  std::atomic<bool> begun = false, done = false;
  {
    std::jthread viewer([&] {
      begun = true;
      while (!done && seen.size() < 200) {
        seen.push_back(engine.image());
        seen_finished.push_back(engine.finished_image());
      }
    });
    while (!begun) std::this_thread::yield();
    engine.run(scene, helpers::at_samples(6000));
    done = true;
  }
  const auto samples_of = [](const FrequencyImage& image) {
    std::uint64_t sum = 0;
    for (const std::uint32_t count : helpers::counts_of(image)) sum += count;
    return sum;
  };
  const auto expect_among = [&](const std::vector<FrequencyImage>& views,
                                const std::vector<FrequencyImage>& all) {
    for (const FrequencyImage& view : views) {
      bool found = false;
      for (const FrequencyImage& one : all) {
        found = found || (samples_of(one) == samples_of(view) && helpers::same_image(one, view));
      }
      EXPECT_TRUE(found) << samples_of(view) << " samples";
    }
  };
  EXPECT_TRUE(helpers::same_image(fits.back(), engine.image()));
  expect_among(seen, fits);
  expect_among(seen_finished, finished);
}

}  // namespace
}  // namespace freqsynth
