// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/engine.h"
#include "support/engine_helpers.h"
#include "support/other_engine.h"
#include "support/other_parts.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using namespace helpers::other;
using helpers::FewestSamples;
using helpers::MeanRefiner;

TEST(OtherMeasure, StrictOrderAsksForABlockOfFewestSamples) {
  auto engine = make_engine<FewestSamples>(1);
  engine.set_stop(helpers::at_samples(700));
  std::size_t looked = 0;
  serve(engine, 1, sample, [&](const Request& request) {
    if (request.again) return;
    engine.read([&](const BlockGrid& grid, const Blocks& blocks) {
      std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max();
      for (std::uint32_t b = 0; b < grid.size(); ++b) fewest = std::min(fewest, blocks.samples(b));
      std::set<std::uint64_t> next;
      for (std::uint32_t b = 0; b < grid.size(); ++b) {
        if (blocks.samples(b) != fewest) continue;
        next.insert(grid.name(b, fewest, helpers::shared_list()->position(fewest)));
      }
      ASSERT_TRUE(next.contains(request.id)) << "fewest samples: " << fewest;
      ++looked;
    });
  });
  EXPECT_EQ(looked, 700u);
}

/// Once there is noise, nothing matters but block 7.
class MadByNoise : public FewestSamples {
 public:
  template <Refiner R>
  [[nodiscard]] bool notice_noise(const BlockView<R>&) {
    noisy_ = true;
    return true;
  }
  template <Refiner R>
  [[nodiscard]] float priority(const BlockView<R>& view, std::uint32_t block, float factor) const {
    if (!noisy_) return FewestSamples::priority(view, block, factor);
    return block == 7 ? 2.0f : 1e-6f;
  }

 private:
  bool noisy_ = false;
};

TEST(OtherMeasure, IsToldOfNoiseAndAllBlocksArePutInOrderAnew) {
  for (const Noise noise : {Noise::automatic, Noise::none}) {
    const BlockGrid grid = BlockGrid::of(width, height, channels);
    Engine<MeanRefiner, MadByNoise> engine(
        grid, Blocks(MeanRefiner(helpers::shared_list(), channels), grid.size(), 1000), {},
        std::vector<float>(grid.size(), 1), 1, 0, 0, noise);
    engine.set_stop(helpers::at_samples(400));
    std::size_t told = 0, asked_7 = 0;
    std::vector<Request> requests(4);
    while (const std::size_t count = engine.request(requests)) {
      const std::span all = std::span(requests).first(count);
      if (engine.noisy()) {
        const std::uint32_t next =
            engine.read([](const BlockGrid&, const Blocks& blocks) { return blocks.samples(7); });
        ++told;
        asked_7 += all[0].id == grid.name(7, next, helpers::shared_list()->position(next)) ? 1 : 0;
      }
      std::vector<float> values;
      for (const Request& request : all) {
        // The second value of a point is another one, but not at first.
        const float value = request.again && engine.stats().samples > 100 ? 5.0f : 1.0f;
        values.insert(values.end(), {value, 1});
      }
      engine.deliver(all, values);
    }
    EXPECT_EQ(told > 200, noise == Noise::automatic);
    EXPECT_EQ(asked_7, told);
    EXPECT_GT(engine.stats().differing_probes, 5u);
  }
}

TEST(OtherMeasure, MeasuresThatLookAtValuesPreferABusyPart) {
  // Two of five columns are flat. Of the first one an even share is a fifth.
  const auto picture = [](double x, double y) {
    const auto value = static_cast<float>(x < 16 ? 1 : std::sin(2.3 * x) * std::cos(1.9 * y));
    return std::array{value, value};
  };
  const auto share_of_left = [&](auto engine) {
    engine->set_stop(helpers::at_samples(900));
    serve(*engine, 16, picture, [](const Request&) {});
    return engine->read([](const BlockGrid& grid, const Blocks& blocks) {
      double left = 0, all = 0;
      for (std::size_t b = 0; b < grid.size(); ++b) {
        const double samples = blocks.samples(b);
        all += samples;
        if (grid.column(b) == 0) left += samples;
      }
      return left / all;
    });
  };
  const auto share = [&]<class M>() {
    auto engine = make_engine<M>(0);
    return share_of_left(&engine);
  };
  EXPECT_LT(share.template operator()<ChangeMeasure>(), 0.15);
  EXPECT_LT(share.template operator()<ResidualMeasure>(), 0.15);
  EXPECT_NEAR(share.template operator()<FewestSamples>(), 0.2, 0.01);
}

}  // namespace
}  // namespace freqsynth
