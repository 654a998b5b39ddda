// SPDX-License-Identifier: MIT
#include "freqsynth/synthesizer.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/sample_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::at_samples_per_pixel;
using helpers::at_threshold;
using helpers::counts_of;
using helpers::picture;
using helpers::Point;
using helpers::settings_of;

static_assert(Sampler<float (*)(double, double)>);
static_assert(ScalarSampler<double (*)(double, double)>);
static_assert(ScalarSampler<std::array<float, 3> (*)(double, double)>);
static_assert(BatchSampler<void (*)(std::span<const Request>, std::span<float>)>);
static_assert(!Sampler<void (*)(double, double)>);
static_assert(!Sampler<float (*)(double)>);
static_assert(!Sampler<std::array<float, 0> (*)(double, double)>);
static_assert(!Sampler<const char* (*)(double, double)>);

struct Lattice {
  std::size_t blocks_x, blocks_y;
  std::size_t level;  // 2^level steps per block
  std::size_t wave;
};

class FullLattice : public testing::TestWithParam<Lattice> {};
INSTANTIATE_TEST_SUITE_P(Sizes, FullLattice,
                         testing::Values(Lattice{1, 1, 2, 0}, Lattice{3, 2, 2, 1},
                                         Lattice{3, 2, 3, 0}, Lattice{4, 5, 2, 7},
                                         Lattice{5, 4, 3, 1000}, Lattice{1, 6, 2, 3},
                                         Lattice{7, 1, 3, 1}));

TEST_P(FullLattice, AsksEveryPointOnce) {
  const auto [blocks_x, blocks_y, level, wave] = GetParam();
  const std::size_t steps = std::size_t{1} << level;
  SynthesisSettings settings = settings_of(8 * blocks_x, 8 * blocks_y, 1, wave);
  settings.max_samples_per_block = (steps + 1) * (steps + 1);
  settings.list.positions = SamplePositions::lattice;
  Synthesizer engine(settings);
  const auto points = helpers::asked_points(engine, StopRule{}, picture);
  EXPECT_EQ(engine.stopped(), StopReason::exhausted);

  std::set<Point> expected;
  for (std::size_t i = 0; i <= steps * blocks_x; ++i) {
    for (std::size_t j = 0; j <= steps * blocks_y; ++j) {
      const double step = 8.0 / static_cast<double>(steps);
      expected.insert({static_cast<double>(i) * step, static_cast<double>(j) * step});
    }
  }
  ASSERT_EQ(expected.size(), (steps * blocks_x + 1) * (steps * blocks_y + 1));
  EXPECT_EQ(points.size(), expected.size()) << "a point was asked twice or never";
  EXPECT_EQ(std::set<Point>(points.begin(), points.end()), expected);
  EXPECT_EQ(engine.stats().samples, expected.size());
  EXPECT_EQ(engine.stats().blocks, blocks_x * blocks_y);
  EXPECT_EQ(engine.stats().absorbed, blocks_x * blocks_y * settings.max_samples_per_block);
  for (const std::uint32_t count : counts_of(engine.image())) {
    EXPECT_EQ(count, settings.max_samples_per_block);
  }
}

TEST_P(FullLattice, FitsEveryBlockToItsOwnSamples) {
  const auto [blocks_x, blocks_y, level, wave] = GetParam();
  const std::size_t samples = ((std::size_t{1} << level) + 1) * ((std::size_t{1} << level) + 1);
  SynthesisSettings settings = settings_of(8 * blocks_x, 8 * blocks_y, 2, wave);
  settings.max_samples_per_block = samples;
  settings.list.positions = SamplePositions::lattice;
  Synthesizer engine(settings);
  engine.run(
      [](double x, double y) {
        return std::array{picture(x, y), 1 - 2 * picture(y, x)};
      },
      StopRule{});
  const FrequencyImage image = engine.image();
  const InverseList list(settings.list);
  for (std::size_t y = 0; y < blocks_y; ++y) {
    for (std::size_t x = 0; x < blocks_x; ++x) {
      oracle::LeastSquares first, second;
      for (std::size_t n = 0; n < samples; ++n) {
        const SequencePosition& at = list.position(n);
        const double px = 8 * (static_cast<double>(x) + at.s);
        const double py = 8 * (static_cast<double>(y) + at.t);
        first.add(at.s, at.t, picture(px, py));
        second.add(at.s, at.t, 1 - 2 * picture(py, px));
      }
      const std::size_t terms = list.terms(samples - 1);
      const auto expected = std::array{first.coefficients(terms), second.coefficients(terms)};
      for (std::size_t c = 0; c < 2; ++c) {
        for (std::size_t i = 0; i < max_terms; ++i) {
          // One rounding or so of values up to 4 per sample; F is at most 8 times the amplitude.
          const double tolerance =
              8 * 4 * 4 * oracle::float_rounding * static_cast<double>(samples + 16);
          ASSERT_NEAR(image.coefficients(x, y, c)[i], static_cast<double>(expected[c][i]),
                      tolerance);
        }
      }
    }
  }
}

TEST(Synthesizer, IdsNameThePointWhateverTheWaveAndBatch) {
  using Asked = std::pair<Point, bool>;  // whether again
  std::map<Asked, std::uint64_t> id_of;
  std::map<std::uint64_t, Asked> point_of;
  for (const std::size_t wave : {1u, 0u, 13u, 10000u}) {
    for (const std::size_t batch : {1u, 1024u}) {
      Synthesizer engine(settings_of(40, 32, 1, wave));
      const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          const Request& request = requests[i];
          const Asked point({request.x, request.y}, request.again);
          ASSERT_EQ(id_of.try_emplace(point, request.id).first->second, request.id);
          ASSERT_EQ(point_of.try_emplace(request.id, point).first->second, point);
          values[i] = picture(request.x, request.y);
        }
      };
      engine.run(sampler, at_samples(1500), SerialExecutor{}, KeepGoing{}, batch);
    }
  }
  EXPECT_EQ(id_of.size(), point_of.size());
  EXPECT_GE(id_of.size(), 1500u);
}

TEST(Synthesizer, SpacingIsTheDistanceToTheBlocksEarlierSamples) {
  SynthesisSettings settings = settings_of(8, 8);
  settings.list.positions = SamplePositions::lattice;
  Synthesizer engine(settings);
  std::vector<Point> earlier;
  const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      values[i] = picture(requests[i].x, requests[i].y);
      if (requests[i].again) continue;
      double nearest = earlier.empty() ? 8 : 1e9;
      for (const auto& [x, y] : earlier) {
        nearest = std::min(nearest, std::hypot(requests[i].x - x, requests[i].y - y));
      }
      EXPECT_FLOAT_EQ(requests[i].spacing, static_cast<float>(nearest));
      earlier.push_back({requests[i].x, requests[i].y});
    }
  };
  engine.run(sampler, at_samples(289));
  EXPECT_EQ(earlier.size(), 289u);
}

class AnySize : public testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};
INSTANTIATE_TEST_SUITE_P(Sizes, AnySize,
                         testing::Values(std::pair{1, 1}, std::pair{7, 9}, std::pair{8, 8},
                                         std::pair{9, 8}, std::pair{1, 33}, std::pair{257, 89}));

TEST_P(AnySize, PositionsLieInTheImageAndLimitsAreExact) {
  const auto [width, height] = GetParam();
  const double pixels = static_cast<double>(width * height);
  for (const double samples_per_pixel : {0.0, 0.3, 1.0, 1.7}) {
    Synthesizer engine(settings_of(width, height));
    const auto points =
        helpers::asked_points(engine, at_samples_per_pixel(samples_per_pixel), picture);
    for (const auto& [x, y] : points) {
      ASSERT_TRUE(x >= 0 && x <= static_cast<double>(width)) << x;
      ASSERT_TRUE(y >= 0 && y <= static_cast<double>(height)) << y;
    }
    EXPECT_EQ(points.size(), static_cast<std::size_t>(std::round(samples_per_pixel * pixels)));
    EXPECT_EQ(engine.stats().samples, points.size());
    EXPECT_EQ(engine.stopped(), StopReason::samples);
    EXPECT_EQ(engine.image().width(), width);
    EXPECT_EQ(engine.image().height(), height);
    EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(engine.image())));
  }
}

TEST(Synthesizer, SmallerOfTwoSampleLimitsHolds) {
  StopRule stop;
  stop.samples_per_pixel = 0.5;
  for (const std::uint64_t samples : {1u, 17u, 127u, 128u, 5000u}) {
    stop.samples = samples;
    Synthesizer engine(settings_of(16, 16));
    EXPECT_EQ(engine.run(picture, stop).reason, StopReason::samples);
    EXPECT_EQ(engine.stats().samples, std::min<std::uint64_t>(samples, 128));
  }
}

TEST(Synthesizer, OneRayPerBlockGivesMostBlocksFourCorners) {
  for (const std::size_t wave : {0u, 1u, 1000000u}) {
    constexpr std::size_t blocks_x = 20, blocks_y = 15;
    Synthesizer engine(settings_of(8 * blocks_x, 8 * blocks_y, 1, wave));
    engine.run(picture, at_samples_per_pixel(1.0 / 64));
    EXPECT_EQ(engine.stats().samples, blocks_x * blocks_y);
    const auto counts = counts_of(engine.image());
    EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 1u);
    // All but the last column and row see the upper left corners of their neighbours.
    EXPECT_EQ(std::count_if(counts.begin(), counts.end(), [](auto n) { return n >= 4; }),
              (blocks_x - 1) * (blocks_y - 1));
  }
}

TEST(Synthesizer, GoesOnWhenTheLimitIsRaised) {
  Synthesizer engine(settings_of(40, 24, 1, 1)), straight(settings_of(40, 24, 1, 1));
  std::set<Point> points;
  for (const std::uint64_t limit : {1u, 100u, 101u, 900u, 900u, 50u}) {
    for (const Point& point : helpers::asked_points(engine, at_samples(limit), picture)) {
      EXPECT_TRUE(points.insert(point).second) << "asked twice";
    }
  }
  EXPECT_EQ(points.size(), 900u);
  EXPECT_EQ(engine.stats().waves, 900u);
  straight.run(picture, at_samples(900));
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(Synthesizer, StopsWhenEveryBlockIsBelowTheThreshold) {
  std::uint64_t before = 0;
  for (const double threshold : {0.1, 0.03, 0.01, 0.003}) {
    Synthesizer engine(settings_of(48, 40));
    EXPECT_EQ(engine.run(picture, at_threshold(threshold)).reason, StopReason::threshold);
    EXPECT_EQ(engine.stopped(), StopReason::threshold);
    EXPECT_GT(engine.stats().samples, before) << "a lower threshold takes more samples";
    before = engine.stats().samples;
    // Lowering the threshold goes on.
    engine.set_stop(at_threshold(threshold / 3));
    EXPECT_EQ(engine.stopped(), std::nullopt);
  }
}

TEST(Synthesizer, ThresholdIsInTheSignalsUnit) {
  const auto counts_for = [](float scale) {
    Synthesizer engine(settings_of(48, 40));
    engine.run([&](double x, double y) { return scale * picture(x, y); },
               at_threshold(0.01 * scale));
    return counts_of(engine.image());
  };
  EXPECT_EQ(counts_for(256), counts_for(1));
  EXPECT_EQ(counts_for(1.0f / 64), counts_for(1));
}

TEST(Synthesizer, ScalingByAPowerOfTwoChangesNothing) {
  for (const int exponent : {-10, 10, 30}) {
    Synthesizer engine(settings_of(64, 48)), scaled(settings_of(64, 48));
    const auto factor = static_cast<float>(std::ldexp(1, exponent));
    const auto points = helpers::asked_points(engine, at_samples(4000), picture);
    const auto scaled_points = helpers::asked_points(
        scaled, at_samples(4000), [&](double x, double y) { return factor * picture(x, y); });
    EXPECT_EQ(points, scaled_points);
    std::vector<float> expected = helpers::coefficients_of(engine.image());
    for (float& value : expected) value *= factor;
    EXPECT_EQ(helpers::coefficients_of(scaled.image()), expected);
  }
}

TEST(Synthesizer, AnyOtherScaleChangesLittle) {
  for (const float factor : {255.0f, 1e5f, 1e-3f}) {
    Synthesizer engine(settings_of(128, 96)), scaled(settings_of(128, 96));
    engine.run(picture, at_samples(8000));
    scaled.run([&](double x, double y) { return factor * picture(x, y); }, at_samples(8000));
    const auto counts = counts_of(engine.image()), other = counts_of(scaled.image());
    std::size_t differences = 0;
    for (std::size_t b = 0; b < counts.size(); ++b) {
      const auto low = std::min(counts[b], other[b]);
      differences += std::max(counts[b], other[b]) - low;
    }
    // Only rounding differs: it can exchange blocks of almost equal priority, one sample each. None
    // was measured.
    EXPECT_LE(differences, 4u) << "factor " << factor;
  }
}

}  // namespace
}  // namespace freqsynth
