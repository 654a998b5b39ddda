// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/engine.h"
#include "freqsynth/image/block_images.h"
#include "freqsynth/refine/refiner.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"
#include "support/other_engine.h"
#include "support/other_parts.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using namespace helpers::other;
using helpers::FewestSamples;
using helpers::MeanRefiner;
using oracle::float_rounding;
using oracle::Real;

struct Moments {
  Real mean = 0, squares = 0;
};

/// Of the first samples of a block, wherever they came from: two passes.
Moments moments_of(const BlockGrid& grid, std::size_t block, std::size_t samples,
                   std::size_t channel) {
  std::vector<Real> values;
  for (std::size_t i = 0; i < samples; ++i) {
    const BlockGrid::Point point = grid.point(block, helpers::shared_list()->position(i));
    values.push_back(static_cast<Real>(sample(point.x, point.y)[channel]));
  }
  Moments moments;
  for (const Real value : values) moments.mean += value / static_cast<Real>(samples);
  for (const Real value : values) moments.squares += std::pow(value - moments.mean, 2);
  return moments;
}

void expect_means(const BlockGrid& grid, const Blocks& blocks) {
  const FrequencyImage image = fit_image(grid, blocks);
  ASSERT_EQ(image.width(), width);
  ASSERT_EQ(image.height(), height);
  ASSERT_EQ(image.channels(), channels);
  EXPECT_EQ(image.meaning(), CoefficientMeaning::point_function);
  for (std::size_t b = 0; b < grid.size(); ++b) {
    const std::size_t n = blocks.samples(b);
    ASSERT_EQ(image.samples(grid.column(b), grid.row(b)), n);
    for (std::size_t c = 0; c < channels; ++c) {
      const Moments expected = moments_of(grid, b, n, c);
      // Values are below 4; each sample rounds a few times.
      const double bound = 16 * float_rounding * static_cast<double>(n);
      const auto coefficients = image.coefficients(grid.column(b), grid.row(b), c);
      ASSERT_NEAR(coefficients[0] / 8, static_cast<double>(expected.mean), bound) << "block " << b;
      for (std::size_t i = 1; i < max_terms; ++i) ASSERT_EQ(coefficients[i], 0);
      const float residual = std::ldexp(blocks.residual(b, c), 2 * blocks.exponent(c));
      ASSERT_NEAR(residual * blocks.freedom(b), static_cast<double>(expected.squares),
                  4 * static_cast<double>(n) * bound);
    }
  }
}

/// A point is asked for when, and only when, it is one of the samples of a block; and once.
void expect_conserved(const BlockGrid& grid, const Blocks& blocks, const SynthesisStats& stats,
                      const std::map<std::uint64_t, int>& asked) {
  std::set<std::uint64_t> wanted, known;
  std::size_t absorbed = 0;
  for (std::uint32_t b = 0; b < grid.size(); ++b) {
    for (std::uint32_t i = 0; i < blocks.samples(b); ++i) {
      wanted.insert(grid.name(b, i, helpers::shared_list()->position(i)));
      ++absorbed;
    }
  }
  for (const auto& [name, times] : asked) {
    known.insert(name);
    EXPECT_EQ(times, 1) << "point " << name;
  }
  EXPECT_EQ(known, wanted);
  EXPECT_EQ(stats.samples, asked.size());
  EXPECT_EQ(stats.absorbed, absorbed);
  EXPECT_EQ(stats.bad_samples, 0u);
  EXPECT_EQ(stats.blocks, grid.size());
}

template <class M>
class OtherRefiner : public testing::Test {};
using Measures = testing::Types<ChangeMeasure, ResidualMeasure, FewestSamples>;
TYPED_TEST_SUITE(OtherRefiner, Measures);

TYPED_TEST(OtherRefiner, BlocksAreTheMeansOfTheSamplesRoutedToThem) {
  for (const std::size_t wave :
       {std::size_t{0}, std::size_t{1}, std::size_t{5}, std::size_t{999}}) {
    for (const std::uint64_t budget : {7u, 40u, 1500u}) {
      auto engine = make_engine<TypeParam>(wave);
      engine.set_stop(helpers::at_samples(budget));
      std::map<std::uint64_t, int> asked;
      serve(engine, 4, sample, [&](const Request& request) {
        if (!request.again) ++asked[request.id];
      });
      EXPECT_EQ(engine.stopped(), StopReason::samples);
      const SynthesisStats stats = engine.stats();
      EXPECT_EQ(stats.samples, budget);
      engine.read([&](const BlockGrid& grid, const Blocks& blocks) {
        expect_means(grid, blocks);
        expect_conserved(grid, blocks, stats, asked);
      });
    }
  }
}

TYPED_TEST(OtherRefiner, AllBlocksGetTheirMostSamples) {
  auto engine = make_engine<TypeParam>(0, 25);
  std::map<std::uint64_t, int> asked;
  serve(engine, 3, sample, [&](const Request& request) {
    if (!request.again) ++asked[request.id];
  });
  EXPECT_EQ(engine.stopped(), StopReason::exhausted);
  const SynthesisStats stats = engine.stats();
  // 5 x 3 lattices of 5 x 5 that share their borders.
  EXPECT_EQ(stats.samples, (4u * 5 + 1) * (4 * 3 + 1));
  EXPECT_EQ(stats.absorbed, 25u * 15);
  engine.read([&](const BlockGrid& grid, const Blocks& blocks) {
    for (std::size_t b = 0; b < grid.size(); ++b) EXPECT_EQ(blocks.samples(b), 25u);
    expect_means(grid, blocks);
    expect_conserved(grid, blocks, stats, asked);
  });
}

TYPED_TEST(OtherRefiner, FinishesAConstantImageAsAConstant) {
  auto engine = make_engine<TypeParam>(0);
  engine.set_stop(helpers::at_samples(2000));
  const auto constant = [](double, double) { return std::array{0.75f, -3.0f}; };
  serve(engine, 64, constant, [](const Request&) {});
  const FrequencyImage image = engine.read([](const BlockGrid& grid, const Blocks& blocks) {
    return finished_image(grid, blocks, helpers::shared_list(), {});
  });
  EXPECT_EQ(image.meaning(), CoefficientMeaning::pixel_average);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      for (std::size_t c = 0; c < channels; ++c) {
        const double expected = c == 0 ? 8 * 0.75 : 8 * -3.0;
        const auto coefficients = image.coefficients(x, y, c);
        EXPECT_NEAR(coefficients[0], expected, 1e-4);
        for (std::size_t i = 1; i < max_terms; ++i) ASSERT_NEAR(coefficients[i], 0, 1e-4);
      }
    }
  }
}

TYPED_TEST(OtherRefiner, BadValuesAreTheEstimatorsBusiness) {
  auto engine = make_engine<TypeParam>(5);
  engine.set_stop(helpers::at_samples(600));
  // One channel is unusable in a part of the image that has whole blocks in it.
  std::set<std::uint64_t> bad;
  const float nan = std::bit_cast<float>(0x7fc00000u);
  const auto is_bad = [](double x, double y) { return x > 20 && x < 34 && y > 3; };
  const auto half = [&](double x, double y) { return std::array{is_bad(x, y) ? nan : 1.5f, 0.5f}; };
  serve(engine, 8, half, [&](const Request& request) {
    if (is_bad(request.x, request.y) && !request.again) bad.insert(request.id);
  });
  ASSERT_GT(bad.size(), 50u);
  EXPECT_EQ(engine.stats().bad_samples, bad.size());
  std::set<std::uint64_t> reported;
  for (const BadSample& one : engine.bad_samples()) {
    EXPECT_TRUE(is_bad(one.x, one.y));
    reported.insert(one.id);
  }
  EXPECT_EQ(reported, bad);
  engine.read([&](const BlockGrid& grid, const Blocks& blocks) {
    const FrequencyImage image = fit_image(grid, blocks);
    for (std::size_t b = 0; b < grid.size(); ++b) {
      const std::size_t x = grid.column(b), y = grid.row(b);
      bool any = false;
      for (std::size_t i = 0; i < blocks.samples(b); ++i) {
        const BlockGrid::Point point = grid.point(b, helpers::shared_list()->position(i));
        any = any || !is_bad(point.x, point.y);
      }
      EXPECT_EQ(image.coefficients(x, y, 0)[0], any ? 12 : 0) << "block " << b;
      EXPECT_EQ(image.coefficients(x, y, 1)[0], 4) << "block " << b;
    }
    // Block (3, 1) lies within.
    EXPECT_EQ(image.coefficients(3, 1, 0)[0], 0);
  });
}

}  // namespace
}  // namespace freqsynth
