// SPDX-License-Identifier: MIT
// Blocks are asked for several samples that follow each other in their sequence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/visit_plan.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

/// Calls look(requests) for each wave, without those that ask once more, and answers it.
template <class Look>
void serve_waves(Synthesizer& engine, Look&& look) {
  std::vector<Request> requests(100000);
  while (const std::size_t count = engine.request(requests)) {
    const std::span<const Request> wave = std::span(requests).first(count);
    std::vector<Request> once;
    std::vector<float> values;
    for (const Request& request : wave) {
      if (!request.again) once.push_back(request);
      values.push_back(picture(request.x, request.y));
    }
    look(once);
    engine.deliver(wave, values);
  }
}

/// The block that a request is named after, and the index in its sequence.
std::pair<std::uint32_t, std::uint32_t> named(const Request& request) {
  return {static_cast<std::uint32_t>(request.id >> 21),
          static_cast<std::uint32_t>(request.id & ((1u << 21) - 1))};
}

TEST(Visits, InteriorSamplesOfABlockFollowEachOtherAndBlocksComeInOrder) {
  const SharedInverseList list = helpers::shared_list();
  Synthesizer engine(settings_of(160, 120, 1, 0));
  engine.set_stop({.samples_per_pixel = 3});
  std::vector<std::uint32_t> counts(20 * 15);
  std::size_t several = 0, waves = 0;
  serve_waves(engine, [&](const std::vector<Request>& wave) {
    ++waves;
    std::map<std::uint32_t, std::vector<std::uint32_t>> visits;
    std::uint32_t last = 0;
    for (const Request& request : wave) {
      const auto [block, index] = named(request);
      if (list->position(index).side != BlockSide::interior) continue;  // may be another block's
      ASSERT_GE(block, last);
      last = block;
      visits[block].push_back(index);
    }
    for (const auto& [block, indices] : visits) {
      EXPECT_LE(indices.size(), 8u);
      EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
      EXPECT_GE(indices.front(), counts[block]) << "no sample is asked for twice";
      EXPECT_LE(indices.size(), std::max<std::size_t>(indices.front() / 8, 1));
      for (std::uint32_t i = indices.front(); i < indices.back(); ++i) {
        const bool asked = std::find(indices.begin(), indices.end(), i) != indices.end();
        EXPECT_EQ(asked, list->position(i).side == BlockSide::interior) << "none is left out";
      }
      counts[block] = indices.back() + 1;
      several += indices.size() > 1 ? 1 : 0;
    }
  });
  EXPECT_GT(several, 3 * waves);
}

TEST(Visits, EveryWaveIsAtMostTheWaveSize) {
  for (const std::size_t wave : {0u, 1u, 3u, 50u, 100000u}) {
    Synthesizer engine(settings_of(75, 93, 1, wave));
    const std::size_t blocks = 10 * 12;
    const std::size_t chosen = wave == 0 ? blocks / 32 : std::min(wave, blocks);
    std::size_t largest = 0;
    engine.set_stop({.samples_per_pixel = 4});
    serve_waves(engine, [&](const std::vector<Request>& requests) {
      largest = std::max(largest, requests.size());
    });
    EXPECT_LE(largest, (wave == 1 ? 1 : 8) * chosen);
    EXPECT_GT(largest, (wave == 1 ? 0 : 6) * chosen);
  }
}

TEST(Visits, NoLimitIsPassedAndNoPointIsAskedForTwice) {
  for (const std::size_t wave : {0u, 1u, 5u, 100000u}) {
    for (const std::uint64_t samples : {1u, 100u, 2500u, 2501u, 20003u}) {
      Synthesizer engine(settings_of(75, 53, 1, wave));
      engine.set_stop(at_samples(samples));
      std::set<std::uint64_t> asked;
      serve_waves(engine, [&](const std::vector<Request>& requests) {
        for (const Request& request : requests) {
          EXPECT_TRUE(asked.insert(request.id).second) << request.id;
        }
        EXPECT_LE(asked.size(), samples);
      });
      EXPECT_EQ(asked.size(), samples);
      EXPECT_EQ(engine.stopped(), StopReason::samples);
    }
  }
}

/// Where all blocks are to have the same number, no visit takes one further than the others.
TEST(Visits, EvenSamplesStayEven) {
  for (const double samples : {1.0, 2.0, 2.7, 4.0, 8.0}) {
    SynthesisSettings settings = settings_of(80, 64, 1, 0);
    settings.priority.exploration = 1;
    Synthesizer engine(settings);
    engine.run(picture, {.samples_per_pixel = samples});
    const FrequencyImage image = engine.image();
    std::vector<std::size_t> counts;
    for (std::size_t y = 0; y < 8; ++y) {
      for (std::size_t x = 0; x < 10; ++x) counts.push_back(image.samples(x, y));
    }
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    // One more, and what neighbours know: two partners across the block.
    EXPECT_LE(*most - *least, 3u) << samples << " samples per pixel";
  }
}

}  // namespace
}  // namespace freqsynth
