// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_measure.h"
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
using oracle::float_rounding;
using oracle::Real;

static_assert(BlockMeasure<ChangeMeasure, LeastSquaresRefiner>);
static_assert(BlockMeasure<ResidualMeasure, LeastSquaresRefiner>);

/// A few dozen roundings of positive numbers.
double tolerance(Real expected) { return 40 * float_rounding * static_cast<double>(expected); }

/// An image whose blocks say of themselves what the test wants.
template <class R>
struct Image {
  Image(std::size_t blocks_x, std::size_t blocks_y, R refiner, std::size_t most = 300)
      : grid(BlockGrid::of(8 * blocks_x, 8 * blocks_y, refiner.channels())),
        blocks(std::move(refiner), grid.size(), most),
        signal(blocks.refiner().channels()) {}

  [[nodiscard]] BlockView<R> view() const { return {grid, blocks, signal}; }
  /// Blocks that share an edge with this one.
  [[nodiscard]] std::vector<Block> beside(Block block) const {
    std::vector<Block> found;
    for (Block other = 0; other < grid.size(); ++other) {
      const auto dx = static_cast<int>(grid.column(block)) - static_cast<int>(grid.column(other));
      const auto dy = static_cast<int>(grid.row(block)) - static_cast<int>(grid.row(other));
      if (std::abs(dx) + std::abs(dy) == 1) found.push_back(other);
    }
    return found;
  }
  /// A signal that varies by `spread` around `level` in each channel.
  void settle(float level, float spread) {
    for (const float sign : {-1.0f, 1.0f}) {
      const std::vector<float> values(blocks.refiner().channels(), level + sign * spread);
      signal.add(values.data());
    }
    signal.settle(blocks.refiner().weights());
  }

  BlockGrid grid;
  BlockStore<R> blocks;
  SignalStatistics signal;
};

/// U_n of engine/priority.h per unit of the image's variance: the running average of U r^n, from U
/// on.
Real uncertainty(const PrioritySettings& settings, std::size_t samples) {
  const auto w = static_cast<Real>(settings.weight), r = static_cast<Real>(settings.decay);
  Real running = static_cast<Real>(settings.uncertainty);
  for (std::size_t n = 0; n <= samples; ++n) {
    const Real newest = static_cast<Real>(settings.uncertainty) * std::pow(r, static_cast<Real>(n));
    running = (1 - w) * running + w * newest;
  }
  return running;
}

/// What a sample of a block is worth per unit of its residuals: the share that the step from one
/// even lattice to the next takes away, per sample, of 64 / n.
Real gain_of_sample(std::size_t samples) {
  std::size_t before = 1;
  for (std::size_t k = 1;; k *= 2) {
    const std::size_t level = (k + 1) * (k + 1);
    for (const std::size_t after : {level, level + k * k}) {
      if (samples < after) {
        const auto a = static_cast<Real>(before), b = static_cast<Real>(after);
        return 64 / static_cast<Real>(samples) * (1 - std::pow(a / b, Real{1.5})) / (b - a);
      }
      before = after;
    }
  }
}

/// U r^n / n per unit of the image's variance.
Real doubt(const PrioritySettings& settings, std::size_t samples) {
  const auto n = static_cast<Real>(samples);
  return static_cast<Real>(settings.uncertainty) * std::pow(static_cast<Real>(settings.decay), n) /
         n;
}

std::vector<PrioritySettings> different_settings() {
  return {{},
          {.weight = 1, .uncertainty = 5, .decay = 0.9, .neighbours = 3, .image = 0.25},
          {.weight = 0.05, .uncertainty = 0, .decay = 0, .neighbours = 0, .image = 0},
          {.uncertainty = 0.1, .neighbours = 1e6, .image = 0},
          {.uncertainty = 1e6, .neighbours = 0, .image = 1e6}};
}

// ----------------------------------------------------------------------------------- the change

TEST(ChangeMeasure, IsTheRunningAverageOfEachBlock) {
  for (const PrioritySettings& settings : different_settings()) {
    Image<ScriptedRefiner> image(3, 2, ScriptedRefiner({1}));
    image.settle(0.5f, 2);
    ChangeMeasure measure(settings, 6, 300);
    const auto w = static_cast<Real>(settings.weight);
    std::vector<Real> variations(6);
    Real largest = 0;
    oracle::Random random(1);
    for (int n = 0; n < 500; ++n) {
      const auto block = static_cast<Block>(random.below(6));
      const auto change = static_cast<float>(std::pow(random.uniform(0, 1.5), 6));
      image.blocks.absorb(block, &change);
      measure.absorbed(image.view(), block, std::array{change});
      variations[block] = (1 - w) * variations[block] + w * static_cast<Real>(change);
      largest = std::max(largest, static_cast<Real>(change));
      const float factor = 0.25f * static_cast<float>(random.below(5));
      const std::size_t samples = image.blocks.samples(block);
      const Real u = static_cast<Real>(image.signal.variance()) *
                     (uncertainty(settings, samples) +
                      static_cast<Real>(1e-12) / static_cast<Real>(samples + 1));
      const Real expected = static_cast<Real>(factor) * (variations[block] + u);
      // The running average forgets its roundings as it forgets its values.
      ASSERT_NEAR(measure.priority(image.view(), block, factor), static_cast<double>(expected),
                  tolerance(expected + largest / w))
          << "sample " << n;
    }
  }
}

TEST(ChangeMeasure, HasNothingToTell) {
  Image<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}));
  ChangeMeasure measure({}, 2, 300);
  measure.absorbed(image.view(), 0, std::array{1000.0f});
  EXPECT_FALSE(measure.has_news(0));
  EXPECT_FALSE(measure.cares(1));
  EXPECT_FALSE(measure.cares(0));
}

TEST(ChangeMeasure, EndlessChangeStaysANumber) {
  Image<ScriptedRefiner> image(1, 1, ScriptedRefiner({1}));
  image.settle(0, 1e15f);
  ChangeMeasure measure({.uncertainty = 1e6}, 1, 300);
  const float value = 1;
  float priority = 0;
  for (int n = 0; n < 300; ++n) {
    image.blocks.absorb(0, &value);
    measure.absorbed(image.view(), 0, std::array{std::numeric_limits<float>::infinity()});
    priority = measure.priority(image.view(), 0, 1);
    ASSERT_TRUE(std::isfinite(priority)) << "sample " << n;
    ASSERT_GT(priority, 1e25f);
  }
  // It is forgotten like any other.
  for (int n = 0; n < 100; ++n) measure.absorbed(image.view(), 0, std::array{0.0f});
  EXPECT_LT(measure.priority(image.view(), 0, 1), 1e-3f * priority);
}

TEST(ChangeMeasure, SteeredCountsChangesAsTheyAreSeen) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    PrioritySettings settings;
    settings.steer = steer;
    Image<ScriptedRefiner> image(2, 2, ScriptedRefiner({2}));
    Steering steering(settings, false, {2}, 4);
    ChangeMeasure measure(settings, 4, 300, steering);
    EXPECT_FALSE(measure.in_units());
    std::vector<Real> variations(4);
    const auto w = static_cast<Real>(settings.weight);
    oracle::Random random(1);
    for (int n = 0; n < 300; ++n) {
      // At first each block in turn.
      const auto block = static_cast<Block>(n < 4 ? n : static_cast<int>(random.below(4)));
      const auto change = static_cast<float>(std::pow(random.uniform(0, 0.5), 6));
      image.blocks.absorb(block, &change);
      const float seen = steering.settled() ? steering.change(image.blocks, block, change) : change;
      variations[block] = (1 - w) * variations[block] + w * static_cast<Real>(seen);
      if (steering.absorbed(image.blocks, block)) {
        for (Block b = 0; b < 4; ++b) {
          variations[b] = static_cast<Real>(
              steering.change(image.blocks, b, static_cast<float>(variations[b])));
        }
      }
      measure.absorbed(image.view(), block, std::array{change});
      measure.use_units(image.view(), steering.settled() ? 4.0f : 1.0f);  // is not asked
      const std::size_t samples = image.blocks.samples(block);
      const Real u = static_cast<Real>(steering.variance()) *
                     (uncertainty(settings, samples) +
                      static_cast<Real>(1e-12) / static_cast<Real>(samples + 1));
      const Real expected = variations[block] + u;
      ASSERT_NEAR(measure.priority(image.view(), block, 1), static_cast<double>(expected),
                  tolerance(expected + Real{0.1L}))
          << "sample " << n;
    }
  }
}

// ---------------------------------------------------------------------------------- the residuals

/// Feeds blocks at random, so that they have different residuals and numbers of samples. Calls
/// then(block) after each.
template <class Then>
void feed(Image<ScriptedRefiner>& image, int samples, oracle::Random& random, Then&& then) {
  const std::size_t channels = image.blocks.refiner().channels();
  for (int n = 0; n < samples; ++n) {
    const auto block = static_cast<Block>(random.below(image.grid.size()));
    if (image.blocks.full(block)) continue;
    std::vector<float> values;
    for (std::size_t c = 0; c < channels; ++c) {
      values.push_back(static_cast<float>(std::pow(random.uniform(0, 3), 4)));
    }
    image.blocks.absorb(block, values.data());
    then(block);
  }
}

TEST(ResidualBook, KeepsTheNewestResidualsAndTheirMean) {
  Image<ScriptedRefiner> image(3, 3, ScriptedRefiner({0.5f, 2}));
  ResidualBook book(9);
  EXPECT_EQ(book.mean(), 0);
  oracle::Random random(1);
  const auto check = [&](Block block) {
    book.note(block, plausible_residual(image.view(), block));
    Real sum = 0;
    for (Block b = 0; b < 9; ++b) {
      ASSERT_EQ(book.of(b), image.blocks.residual(b));
      sum += static_cast<Real>(image.blocks.residual(b));
    }
    ASSERT_NEAR(book.mean(), static_cast<double>(sum / 9), tolerance(sum / 9));
  };
  feed(image, 400, random, check);
}

TEST(ResidualBook, AFactorOfOneChangesNotABit) {
  // A sum that is added up anew would not have lost what the great number took away.
  ResidualBook book(2);
  book.note(0, 1e30f);
  book.note(1, 1);
  book.note(0, 0.25f);
  const float mean = book.mean();
  book.rescale(1);
  EXPECT_EQ(book.mean(), mean);
}

TEST(ResidualBook, PoolsAWeightedMeanOfVariances) {
  for (const auto& [x, y] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 4}, {4, 1}, {3, 3}}) {
    Image<ScriptedRefiner> image(x, y, ScriptedRefiner({1}));
    ResidualBook book(x * y);
    oracle::Random random(static_cast<unsigned>(x));
    feed(image, 100, random,
         [&](Block block) { book.note(block, plausible_residual(image.view(), block)); });
    std::vector<float> some(x * y);  // of whatever the caller pools
    for (float& value : some) value = static_cast<float>(random.uniform(0, 5));
    for (Block block = 0; block < x * y; ++block) {
      for (const float neighbours : {0.0f, 16.0f, 1000.0f}) {
        for (const float whole : {0.0f, 1.0f, 77.0f}) {
          const auto own = static_cast<Real>(image.blocks.freedom(block));
          Real sum = own * static_cast<Real>(some[block]), weight = own;
          const auto beside = image.beside(block);
          for (const Block other : beside) {
            const Real share = static_cast<Real>(neighbours) / static_cast<Real>(beside.size());
            sum += share * static_cast<Real>(some[other]);
            weight += share;
          }
          sum += static_cast<Real>(whole) * static_cast<Real>(book.mean());
          weight += static_cast<Real>(whole);
          const float pooled = book.pooled(
              image.view(), block, [&](Block b) { return some[b]; }, neighbours, whole);
          ASSERT_NEAR(pooled, static_cast<double>(sum / weight), tolerance(sum / weight))
              << x << " x " << y << " blocks, block " << block;
        }
      }
    }
  }
}

TEST(ResidualBook, NewsAreResidualsThatHaveGrownByAQuarter) {
  Image<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}), 1000);
  ResidualBook book(2);
  const auto news_after = [&](float residual) {
    image.blocks.absorb(1, &residual);
    book.note(1, plausible_residual(image.view(), 1));
    return book.has_news(1);
  };
  EXPECT_FALSE(book.has_news(1)) << "nothing there";
  EXPECT_FALSE(news_after(0));
  EXPECT_TRUE(news_after(1));
  EXPECT_FALSE(book.has_news(1)) << "told already";
  EXPECT_FALSE(news_after(1.25f));
  EXPECT_TRUE(news_after(1.26f));
  EXPECT_FALSE(news_after(1.5f)) << "over what was told last, not over what was first";
  EXPECT_FALSE(news_after(0.64f));
  EXPECT_FALSE(news_after(1.57f)) << "half or more was no loss to speak of";
  EXPECT_FALSE(news_after(0.62f)) << "less is not told";
  EXPECT_TRUE(news_after(0.78f)) << "but what grows from there is";
  EXPECT_FALSE(book.has_news(0)) << "of others nothing is known";
}

TEST(ResidualMeasure, IsTheExpectedGainOfAPooledResidual) {
  for (const PrioritySettings& settings : different_settings()) {
    Image<ScriptedRefiner> image(4, 3, ScriptedRefiner({0.25f, 0, 3}));
    ResidualMeasure measure(settings, 12, 300);
    oracle::Random random(3);
    const std::vector<float> no_residual(3);
    for (Block block = 0; block < 12; ++block) {
      image.blocks.absorb(block, no_residual.data());
      measure.absorbed(image.view(), block, std::array{0.0f});
    }
    int checks = 0;
    const auto check = [&](Block fed) {
      measure.absorbed(image.view(), fed, std::array{1e9f});  // changes do not count
      if (++checks == 40) image.settle(3, 0.7f);
      if (checks % 10 != 0) return;
      Real mean = 0;
      for (Block b = 0; b < 12; ++b) mean += static_cast<Real>(image.blocks.residual(b)) / 12;
      for (Block block = 0; block < 12; ++block) {
        const std::size_t samples = image.blocks.samples(block);
        const auto n = static_cast<Real>(samples);
        const auto own = static_cast<Real>(image.blocks.freedom(block));
        const auto neighbours = static_cast<Real>(settings.neighbours);
        const auto whole = static_cast<Real>(settings.image);
        Real beside = 0;
        for (const Block other : image.beside(block)) {
          beside += static_cast<Real>(image.blocks.residual(other)) /
                    static_cast<Real>(image.beside(block).size());
        }
        const Real residual = (own * static_cast<Real>(image.blocks.residual(block)) +
                               neighbours * beside + whole * mean) /
                              (own + neighbours + whole);
        const auto variance = static_cast<Real>(image.signal.variance());
        const Real least = static_cast<Real>(1e-12) / (n + 1);
        const Real expected = (residual + static_cast<Real>(image.signal.rounding()) +
                               variance * doubt(settings, samples)) *
                                  gain_of_sample(samples) +
                              variance * least;
        ASSERT_NEAR(measure.priority(image.view(), block, 1), static_cast<double>(expected),
                    tolerance(expected))
            << "block " << block << " of " << samples << " samples";
        ASSERT_EQ(measure.priority(image.view(), block, 0.5f),
                  0.5f * measure.priority(image.view(), block, 1));
      }
    };
    feed(image, 1000, random, check);
    EXPECT_EQ(checks, 1000);
  }
}

TEST(ResidualMeasure, SteeredPoolsResidualsAsTheyAreSeen) {
  const std::vector<float> weights{0.25f, 0, 3};
  for (const Steer steer : {Steer::relative, Steer::display}) {
    PrioritySettings settings;
    settings.steer = steer;
    Image<ScriptedRefiner> image(4, 3, ScriptedRefiner(weights));
    Steering steering(settings, false, weights, 12);
    ResidualMeasure measure(settings, 12, 300, steering);
    EXPECT_FALSE(measure.in_units());
    oracle::Random random(3);
    std::vector<Real> seen(12);
    const auto see = [&](Block b) {
      seen[b] = static_cast<Real>(steering.residual(
          image.blocks, b, [&](std::size_t c) { return image.blocks.residual(b, c); }));
    };
    const auto absorbed = [&](Block block) {
      measure.absorbed(image.view(), block, std::array{1e9f});
      if (steering.absorbed(image.blocks, block)) {
        for (Block b = 0; b < 12; ++b) see(b);
      } else if (steering.settled()) {
        see(block);
      }
    };
    const std::vector<float> first{0.5f, 1, 0.02f};
    for (Block block = 0; block < 12; ++block) {
      image.blocks.absorb(block, first.data());
      absorbed(block);
    }
    ASSERT_TRUE(steering.settled());
    feed(image, 2000, random, [&](Block fed) {
      absorbed(fed);
      measure.use_units(image.view(), 4);  // is not asked
      Real mean = 0;
      for (const Real residual : seen) mean += residual / 12;
      Real beside = 0;
      for (const Block other : image.beside(fed)) {
        beside += seen[other] / static_cast<Real>(image.beside(fed).size());
      }
      const std::size_t samples = image.blocks.samples(fed);
      const auto n = static_cast<Real>(samples);
      const auto own = static_cast<Real>(image.blocks.freedom(fed));
      const Real residual = (own * seen[fed] + 16 * beside + mean) / (own + 17);
      const Real least = static_cast<Real>(1e-12) / (n + 1);
      const auto variance = static_cast<Real>(steering.variance());
      const Real rounding = static_cast<Real>(3.25e-12);
      const Real expected =
          std::min(Real{1}, 64 / n) *
          ((residual + rounding + variance * doubt(settings, samples)) * gain_of_sample(samples) +
           variance * least);
      ASSERT_NEAR(measure.priority(image.view(), fed, 1), static_cast<double>(expected),
                  tolerance(expected))
          << "block " << fed << " of " << samples << " samples";
    });
  }
}

TEST(ResidualMeasure, NoiseThatIsNoticedIsNoiseThatWasKnown) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    const PrioritySettings settings{.steer = steer};
    Image<LeastSquaresRefiner> image(3, 2, LeastSquaresRefiner(helpers::shared_list(), 1));
    const auto measure = [&](bool noisy) {
      return ResidualMeasure(settings, 6, 300, Steering(settings, noisy, {1}, 6));
    };
    ResidualMeasure noticed = measure(false), exact = measure(false), known = measure(true);
    oracle::Random random(1);
    // With fewer than 16 samples a block is looked at after each.
    for (int n = 0; n < 15; ++n) {
      for (Block block = 0; block < 6; ++block) {
        const float value = 0.1f * static_cast<float>(block + 1) +
                            0.09f * static_cast<float>(random.uniform(-1, 1));
        image.blocks.absorb(block, &value);
        for (ResidualMeasure* one : {&noticed, &exact, &known}) {
          one->absorbed(image.view(), block, std::array{1.0f});
        }
      }
    }
    EXPECT_TRUE(noticed.notice_noise(image.view()));
    for (Block block = 0; block < 6; ++block) {
      const auto priority = [&](const ResidualMeasure& one) {
        return one.priority(image.view(), block, 1);
      };
      EXPECT_FLOAT_EQ(priority(noticed), priority(known)) << block;
      EXPECT_NE(priority(exact), priority(known)) << block;
    }
  }
  Image<ScriptedRefiner> image(1, 1, ScriptedRefiner({1}));
  ResidualMeasure linear({}, 1, 300);
  EXPECT_FALSE(linear.notice_noise(image.view())) << "it does not ask";
}

TEST(ResidualMeasure, NarrowBlocksCountByTheRootOfTheirArea) {
  Image<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}));
  image.grid = BlockGrid::of(11, 8, 1);  // the second block has 3 of 8 columns
  ResidualMeasure measure({}, 2, 300);
  const float value = 0.5f;
  for (Block block = 0; block < 2; ++block) {
    for (int i = 0; i < 30; ++i) image.blocks.absorb(block, &value);
    measure.absorbed(image.view(), block, std::array{0.0f});
  }
  ASSERT_EQ(image.blocks.residual(0), image.blocks.residual(1));
  const Real whole = static_cast<Real>(measure.priority(image.view(), 0, 1));
  const Real expected = whole * std::sqrt(Real{3} / 8);
  EXPECT_NEAR(measure.priority(image.view(), 1, 1), static_cast<double>(expected),
              tolerance(expected));
}

TEST(ResidualMeasure, WithoutResidualsTheRoundingIsLeft) {
  Image<ScriptedRefiner> image(2, 1, ScriptedRefiner({2}));
  image.settle(1000, 1);
  ASSERT_GT(image.signal.rounding(), 0);
  ResidualMeasure measure({.uncertainty = 0}, 2, 300);
  const float flat = 0;
  for (std::size_t samples = 1; samples <= 200; ++samples) {
    image.blocks.absorb(0, &flat);
    measure.absorbed(image.view(), 0, std::array{0.0f});
    const auto n = static_cast<Real>(samples);
    // Of 2 times the power of a million and one; and least of all the order of the samples.
    const Real rounding = static_cast<Real>(2e-12) * 1000001;
    const Real least = static_cast<Real>(1e-12) / (n + 1);
    const Real expected = rounding * gain_of_sample(samples) + least;
    ASSERT_NEAR(measure.priority(image.view(), 0, 1), static_cast<double>(expected),
                tolerance(expected))
        << samples << " samples";
  }
}

TEST(ResidualMeasure, TellsOfItsResidualsAndListensAlways) {
  Image<ScriptedRefiner> image(2, 1, ScriptedRefiner({1}));
  ResidualMeasure measure({}, 2, 300);
  EXPECT_FALSE(measure.has_news(0));
  const float residual = 2;
  image.blocks.absorb(0, &residual);
  measure.absorbed(image.view(), 0, std::array{0.0f});
  EXPECT_TRUE(measure.has_news(0));
  EXPECT_FALSE(measure.has_news(0));
  EXPECT_TRUE(measure.cares(0));
  EXPECT_TRUE(measure.cares(5));
}

/// The largest values, of alternating signs, with the largest weights.
template <class Measure>
void expect_finite(const PrioritySettings& settings, Measure measure) {
  const LeastSquaresRefiner refiner(helpers::shared_list(), 2, {1e6f, 1e6f});
  Image<LeastSquaresRefiner> image(2, 2, refiner, 400);
  image.settle(0, most_state_value);
  for (int n = 0; n < 400; ++n) {
    for (Block block = 0; block < 4; ++block) {
      const float value = (n + n / 3) % 2 == 0 ? most_state_value : -most_state_value;
      const float values[] = {value, block % 2 == 0 ? value : -value};
      const float change = image.blocks.absorb(block, values);
      measure.absorbed(image.view(), block, std::array{change});
    }
    for (Block block = 0; block < 4; ++block) {
      const float priority = measure.priority(image.view(), block, 1);
      ASSERT_TRUE(std::isfinite(priority))
          << "uncertainty " << settings.uncertainty << ", sample " << n << ": " << priority;
      ASSERT_GT(priority, 0);
    }
  }
}

TEST(BlockMeasures, StayFiniteForTheLargestValuesAndWeights) {
  for (const double uncertainty : {0.0, 1.0, 1e6}) {
    const PrioritySettings settings = {.uncertainty = uncertainty};
    ASSERT_NO_FATAL_FAILURE(expect_finite(settings, ChangeMeasure(settings, 4, 400)));
    ASSERT_NO_FATAL_FAILURE(expect_finite(settings, ResidualMeasure(settings, 4, 400)));
  }
}

}  // namespace
}  // namespace freqsynth
