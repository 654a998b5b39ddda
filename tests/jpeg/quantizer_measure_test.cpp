// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/quantizer_measure.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "support/oracles.h"
#include "support/refiner_helpers.h"
#include "support/scripted_refiner.h"

namespace freqsynth {
namespace {

using Block = std::uint32_t;
using helpers::ScriptedRefiner;
using oracle::Real;

static_assert(BlockMeasure<QuantizerMeasure, LeastSquaresRefiner>);

constexpr float infinity = std::numeric_limits<float>::infinity();

/// 3 x 2 blocks of 2 channels, whose residuals and coefficients the test makes up.
struct Image {
  [[nodiscard]] BlockView<ScriptedRefiner> view() const { return {grid, blocks, signal}; }

  BlockGrid grid = BlockGrid::of(24, 16, 2);
  BlockStore<ScriptedRefiner> blocks{ScriptedRefiner({1, 1}), 6, 300};
  SignalStatistics signal{2};
};

/// Steps of 1 to 16, some terms dropped.
QuantizationTarget target_of(double tolerance) {
  QuantizationTarget target;
  target.tolerance = tolerance;
  target.steps.resize(2);
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < max_terms; ++i) {
      target.steps[c][i] = i % 11 == 10 ? infinity : static_cast<float>(1 + (i + 5 * c) % 16);
    }
  }
  return target;
}

Real uncertainty(const PrioritySettings& settings, std::size_t samples) {
  const auto w = static_cast<Real>(settings.weight), r = static_cast<Real>(settings.decay);
  Real running = static_cast<Real>(settings.uncertainty);
  for (std::size_t n = 0; n <= samples; ++n) {
    const Real newest = static_cast<Real>(settings.uncertainty) * std::pow(r, static_cast<Real>(n));
    running = (1 - w) * running + w * newest;
  }
  return running + static_cast<Real>(1e-12) / static_cast<Real>(samples + 1);
}

/// Variance of the residuals of a channel: that of the block, and of those beside it as if they
/// were `neighbours` samples more.
Real pooled(const Image& image, Block block, std::size_t channel, double neighbours) {
  std::vector<Block> beside;
  if (block % 3 > 0) beside.push_back(block - 1);
  if (block % 3 < 2) beside.push_back(block + 1);
  beside.push_back(block < 3 ? block + 3 : block - 3);
  Real mean = 0;
  for (const Block other : beside) {
    mean +=
        static_cast<Real>(image.blocks.residual(other, channel)) / static_cast<Real>(beside.size());
  }
  const auto own = static_cast<Real>(image.blocks.freedom(block));
  const auto weight = static_cast<Real>(neighbours);
  return (own * static_cast<Real>(image.blocks.residual(block, channel)) + weight * mean) /
         (own + weight);
}

/// Expected squared error of a block after quantisation, in squared steps.
Real error_of(const Image& image, Block block, const QuantizationTarget& target,
              const PrioritySettings& settings, bool noisy) {
  const std::size_t samples = image.blocks.samples(block);
  Real error = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    Real residual = pooled(image, block, c, settings.neighbours);
    if (!noisy && samples > 64) residual *= std::sqrt(64 / static_cast<Real>(samples));
    residual += uncertainty(settings, samples) * static_cast<Real>(image.signal.variance(c));
    std::array<float, max_terms> coefficients;
    image.blocks.coefficients(block, c, coefficients);
    const auto variances = image.blocks.refiner().variances(samples);
    for (std::size_t i = 0; i < max_terms; ++i) {
      const auto step = static_cast<Real>(target.steps[c][i]);
      if (std::isinf(step)) continue;  // dropped, whatever it is
      const Real variance = residual * static_cast<Real>(variances[i]);
      const Real reach = std::abs(static_cast<Real>(coefficients[i])) + 2 * std::sqrt(variance);
      // Zero, and zero it stays.
      if (i > 0 && reach < step / 2) continue;
      error += variance / (step * step);
    }
  }
  return error;
}

struct Case {
  PrioritySettings settings;
  bool noisy;
};

std::vector<Case> different_cases() {
  return {{{}, false},
          {{}, true},
          {{.uncertainty = 0}, false},
          {{.uncertainty = 20, .neighbours = 0}, false},
          {{.weight = 1, .decay = 0.9, .neighbours = 1000, .image = 50}, true}};
}

class QuantizerPriority : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Cases, QuantizerPriority,
                         testing::Range(std::size_t{0}, different_cases().size()));

TEST_P(QuantizerPriority, IsTheErrorAboveTheTargetPerSample) {
  const auto [settings, noisy] = different_cases()[GetParam()];
  const QuantizationTarget target = target_of(0.25);
  const auto allowed = static_cast<Real>(0.25) * 128 / 12;
  Image image;
  QuantizerMeasure measure(target, settings, noisy, 6, 300);
  oracle::Random random(1);
  std::size_t met = 0, missed = 0;
  for (int n = 0; n < 1200; ++n) {
    const auto block = static_cast<Block>(std::min(random.below(6), random.below(6)));
    if (image.blocks.full(block)) continue;
    // From hardly any to much.
    const auto residual = [&] { return static_cast<float>(std::exp(random.uniform(-4, 7))); };
    const float values[] = {residual(), residual()};
    image.blocks.absorb(block, values);
    measure.absorbed(image.view(), block, std::array{1.0f});
    if (n == 100) {
      const float corners[] = {1, -3, 5, 9};
      image.signal.add(corners);
      image.signal.add(corners + 2);
      image.signal.settle(image.blocks.refiner().weights());
    }
    const Real error = error_of(image, block, target, settings, noisy);
    const auto samples = static_cast<Real>(image.blocks.samples(block));
    const bool done = error <= allowed && samples >= 25;
    const auto expected = static_cast<double>(done ? 0 : std::max(error, allowed) / samples);
    ASSERT_NEAR(measure.priority(image.view(), block, 1), expected, 1e-5 * expected)
        << "block " << block << " after " << samples << " samples";
    ASSERT_EQ(measure.priority(image.view(), block, 4),
              4 * measure.priority(image.view(), block, 1));
    met += done ? 1 : 0;
    missed += error > allowed ? 1 : 0;
  }
  // Both have been there often.
  EXPECT_GT(met, 50u);
  EXPECT_GT(missed, 50u);
}

TEST(QuantizerMeasure, NoiseThatIsNoticedIsNoiseThatWasKnown) {
  Image image;
  QuantizerMeasure noticed(target_of(0.25), {}, false, 6, 300);
  QuantizerMeasure exact(target_of(0.25), {}, false, 6, 300);
  QuantizerMeasure known(target_of(0.25), {}, true, 6, 300);
  const float values[] = {300, 500};
  for (int n = 0; n < 200; ++n) {
    image.blocks.absorb(2, values);
    for (QuantizerMeasure* one : {&noticed, &exact, &known}) {
      one->absorbed(image.view(), 2, std::array{1.0f});
    }
  }
  EXPECT_LT(exact.priority(image.view(), 2, 1), known.priority(image.view(), 2, 1));
  EXPECT_TRUE(noticed.notice_noise(image.view()));
  EXPECT_EQ(noticed.priority(image.view(), 2, 1), known.priority(image.view(), 2, 1));
}

TEST(QuantizerMeasure, NoBlockIsDoneBeforeALattice) {
  Image image;
  QuantizerMeasure measure(target_of(0.25), {.uncertainty = 0}, false, 6, 300);
  const float flat[] = {0, 0};
  for (std::size_t n = 1; n < 60; ++n) {
    image.blocks.absorb(0, flat);
    measure.absorbed(image.view(), 0, std::array{0.0f});
    const double expected = n < 25 ? 0.25 * 128 / 12 / static_cast<double>(n) : 0;
    EXPECT_NEAR(measure.priority(image.view(), 0, 1), expected, 1e-6 * expected) << n << " samples";
  }
}

TEST(QuantizerMeasure, NeighboursKeepABlockInDoubt) {
  Image image;
  QuantizerMeasure measure(target_of(0.25), {.uncertainty = 0}, false, 6, 300);
  const float flat[] = {0, 0}, busy[] = {1e5f, 0};
  for (int n = 0; n < 30; ++n) image.blocks.absorb(0, flat);
  measure.absorbed(image.view(), 0, std::array{0.0f});
  EXPECT_EQ(measure.priority(image.view(), 0, 1), 0);
  image.blocks.absorb(4, busy);  // across the corner
  measure.absorbed(image.view(), 4, std::array{0.0f});
  EXPECT_EQ(measure.priority(image.view(), 0, 1), 0);
  image.blocks.absorb(3, busy);
  measure.absorbed(image.view(), 3, std::array{0.0f});
  EXPECT_GT(measure.priority(image.view(), 0, 1), 0);
}

TEST(QuantizerMeasure, TellsOfItsResidualsThoseWhoAreDone) {
  Image image;
  QuantizerMeasure measure(target_of(0.25), {}, false, 6, 300);
  EXPECT_FALSE(measure.has_news(2));
  const float values[] = {3, 4};
  image.blocks.absorb(2, values);
  measure.absorbed(image.view(), 2, std::array{0.0f});
  EXPECT_TRUE(measure.has_news(2));
  EXPECT_FALSE(measure.has_news(2));
  EXPECT_TRUE(measure.cares(0));
  EXPECT_FALSE(measure.cares(1e-30f));
  EXPECT_FALSE(measure.cares(-infinity));
}

TEST(QuantizerMeasure, IsANumberForTheLargestValuesAndTheSmallestSteps) {
  for (const float step : {1e-15f, 1.0f, infinity}) {
    QuantizationTarget target;
    target.steps.resize(1);
    target.steps[0].fill(step);
    const LeastSquaresRefiner refiner(helpers::shared_list(), 1, {1e6f});
    const BlockGrid grid = BlockGrid::of(16, 8, 1);
    BlockStore<LeastSquaresRefiner> blocks(refiner, 2, 400);
    SignalStatistics signal(1);
    for (const float value : {most_state_value, -most_state_value}) signal.add(&value);
    signal.settle(refiner.weights());
    const BlockView<LeastSquaresRefiner> view{grid, blocks, signal};
    QuantizerMeasure measure(target, {.uncertainty = 1e6, .neighbours = 1e6}, false, 2, 400);
    for (int n = 0; n < 400; ++n) {
      for (const Block block : {Block{0}, Block{1}}) {
        const float value = (n + n / 3) % 2 == 0 ? most_state_value : -most_state_value;
        measure.absorbed(view, block, std::array{blocks.absorb(block, &value)});
        const float priority = measure.priority(view, block, 1);
        ASSERT_TRUE(std::isfinite(priority)) << "step " << step << ", sample " << n;
        if (std::isinf(step)) {
          // Nothing is kept, so that nothing can be wrong.
          ASSERT_EQ(priority > 0, n + 1 < 25);
        } else {
          ASSERT_GT(priority, 0);
        }
      }
    }
  }
}

}  // namespace
}  // namespace freqsynth
