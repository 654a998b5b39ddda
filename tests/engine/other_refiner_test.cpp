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
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/refine/refiner.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using oracle::float_rounding;
using oracle::Real;

// ------------------------------------------------------------------------- an estimator of another
// kind

/// A block is the mean of its samples, and the residual is their variance.
class MeanRefiner {
 public:
  MeanRefiner(SharedInverseList list, std::size_t channels)
      : list_(std::move(list)), weights_(channels, 1 / static_cast<float>(channels)) {}

  [[nodiscard]] const InverseList& list() const { return *list_; }
  [[nodiscard]] std::size_t channels() const { return weights_.size(); }
  [[nodiscard]] std::span<const float> weights() const { return weights_; }

  /// 64 sums of pixels per channel, then per channel the mean, the sum of squared distances to it,
  /// and the number of usable values.
  [[nodiscard]] std::size_t state_size() const { return channels() * (max_terms + 3); }
  void reset(float* state) const { std::fill_n(state, state_size(), 0.0f); }
  void weigh(std::span<const float> weights) { weights_.assign(weights.begin(), weights.end()); }
  void rescale(float* state, std::size_t channel, int exponent) const {
    for (std::size_t i = 0; i < max_terms; ++i) {
      float& sum = state[channel * max_terms + i];
      sum = std::ldexp(sum, exponent);
    }
    float* own = state + channels() * max_terms + 3 * channel;
    own[0] = std::ldexp(own[0], exponent);
    own[1] = std::ldexp(own[1], 2 * exponent);
  }
  float absorb(float* state, std::size_t n, const float* values) const {
    float change = 0;
    for (std::size_t c = 0; c < channels(); ++c) {
      if (!is_usable_sample(values[c])) continue;
      float* own = state + channels() * max_terms + 3 * c;
      const float difference = values[c] - own[0];
      own[2] += 1;
      own[0] += difference / own[2];
      own[1] += difference * (values[c] - own[0]);
      if (own[2] > 1) change += weights_[c] * std::pow(difference / own[2], 2.0f);
      const detail::SampleRow& row = list_->row(n);
      for (std::size_t p = 0; p < row.pixel_count; ++p) {
        state[c * max_terms + row.pixels[p]] += values[c] * row.pixel_weights[p];
      }
    }
    return change;
  }
  void prefetch(const float*, std::size_t) const {}

  [[nodiscard]] float freedom(std::size_t n) const {
    return static_cast<float>(std::max<std::size_t>(n, 2) - 1);
  }
  [[nodiscard]] float residual(const float* state, std::size_t n) const {
    float sum = 0;
    for (std::size_t c = 0; c < channels(); ++c) sum += weights_[c] * residual(state, n, c);
    return sum;
  }
  [[nodiscard]] float residual(const float* state, std::size_t n, std::size_t channel) const {
    return state[channels() * max_terms + 3 * channel + 1] / freedom(n);
  }
  [[nodiscard]] std::size_t terms(std::size_t) const { return 1; }
  [[nodiscard]] std::span<const float, max_terms> variances(std::size_t) const { return ones; }

  void coefficients(const float* state, std::size_t, std::size_t channel,
                    std::span<float, max_terms> out) const {
    std::fill(out.begin(), out.end(), 0.0f);
    out[0] = 8 * state[channels() * max_terms + 3 * channel];
  }
  [[nodiscard]] BlockFit fit(const float* state, std::size_t n, std::size_t channel) const {
    BlockFit fit{{},
                 std::span<const float, max_terms>(state + channel * max_terms, max_terms),
                 residual(state, n, channel)};
    coefficients(state, n, channel, fit.coefficients);
    return fit;
  }

 private:
  static constexpr auto ones = [] {
    std::array<float, max_terms> values{};
    values.fill(1);
    return values;
  }();

  SharedInverseList list_;
  std::vector<float> weights_;
};

static_assert(Refiner<LeastSquaresRefiner>);
static_assert(Refiner<MeanRefiner>);

// A deleted member hides that of the base: all that is missing is this one.
struct WithoutList : MeanRefiner {
  const InverseList& list() const = delete;
};
struct WithoutChannels : MeanRefiner {
  std::size_t channels() const = delete;
};
struct WithoutWeights : MeanRefiner {
  std::span<const float> weights() const = delete;
};
struct WithoutStateSize : MeanRefiner {
  std::size_t state_size() const = delete;
};
struct WithoutWeigh : MeanRefiner {
  void weigh(std::span<const float>) = delete;
};
struct WithoutRescale : MeanRefiner {
  void rescale(float*, std::size_t, int) const = delete;
};
struct WithoutReset : MeanRefiner {
  void reset(float*) const = delete;
};
struct WithoutAbsorb : MeanRefiner {
  float absorb(float*, std::size_t, const float*) const = delete;
};
struct WithoutPrefetch : MeanRefiner {
  void prefetch(const float*, std::size_t) const = delete;
};
struct WithoutFreedom : MeanRefiner {
  float freedom(std::size_t) const = delete;
};
struct WithoutResidual : MeanRefiner {
  using MeanRefiner::residual;
  float residual(const float*, std::size_t) const = delete;
};
struct WithoutResidualOfAChannel : MeanRefiner {
  using MeanRefiner::residual;
  float residual(const float*, std::size_t, std::size_t) const = delete;
};
struct WithoutTerms : MeanRefiner {
  std::size_t terms(std::size_t) const = delete;
};
struct WithoutVariances : MeanRefiner {
  std::span<const float, max_terms> variances(std::size_t) const = delete;
};
struct WithoutCoefficients : MeanRefiner {
  void coefficients(const float*, std::size_t, std::size_t,
                    std::span<float, max_terms>) const = delete;
};
struct WithoutFit : MeanRefiner {
  BlockFit fit(const float*, std::size_t, std::size_t) const = delete;
};
// What is there must be of the right type, too, and work on a state that may not be written to.
struct InDouble : MeanRefiner {
  double freedom(std::size_t n) const { return MeanRefiner::freedom(n); }
};
struct WritesWhileReading : MeanRefiner {
  BlockFit fit(float* state, std::size_t n, std::size_t channel) const {
    return MeanRefiner::fit(state, n, channel);
  }
};
struct OnlyAddsSomething : MeanRefiner {};

static_assert(!Refiner<WithoutList>);
static_assert(!Refiner<WithoutChannels>);
static_assert(!Refiner<WithoutWeights>);
static_assert(!Refiner<WithoutStateSize>);
static_assert(!Refiner<WithoutWeigh>);
static_assert(!Refiner<WithoutRescale>);
static_assert(!Refiner<WithoutReset>);
static_assert(!Refiner<WithoutAbsorb>);
static_assert(!Refiner<WithoutPrefetch>);
static_assert(!Refiner<WithoutFreedom>);
static_assert(!Refiner<WithoutResidual>);
static_assert(!Refiner<WithoutResidualOfAChannel>);
static_assert(!Refiner<WithoutTerms>);
static_assert(!Refiner<WithoutVariances>);
static_assert(!Refiner<WithoutCoefficients>);
static_assert(!Refiner<WithoutFit>);
static_assert(!Refiner<InDouble>);
static_assert(!Refiner<WritesWhileReading>);
static_assert(Refiner<OnlyAddsSomething>);
static_assert(!Refiner<int>);

/// A measure of another kind: blocks with fewer samples first.
class FewestSamples {
 public:
  template <Refiner R>
  void use_units(const BlockView<R>&, float) {}
  template <Refiner R>
  [[nodiscard]] bool notice_noise(const BlockView<R>&) {
    return false;
  }
  template <Refiner R>
  void absorbed(const BlockView<R>&, std::uint32_t, std::span<const float>) {}
  [[nodiscard]] static bool apart() { return true; }
  template <Refiner R>
  double absorbed_apart(const BlockView<R>&, std::uint32_t, std::span<const float>) {
    return 0;
  }
  static void add(double) {}
  template <Refiner R>
  [[nodiscard]] float priority(const BlockView<R>& view, std::uint32_t block, float) const {
    return 1 / static_cast<float>(view.blocks.samples(block));
  }
  [[nodiscard]] bool has_news(std::uint32_t) { return false; }
  [[nodiscard]] bool cares(float) const { return false; }
  [[nodiscard]] static bool in_units() { return true; }
};

struct WithoutPriority : FewestSamples {
  template <Refiner R>
  float priority(const BlockView<R>&, std::uint32_t, float) const = delete;
};
struct WithoutUnits : FewestSamples {
  template <Refiner R>
  void use_units(const BlockView<R>&, float) = delete;
};
struct WithoutNews : FewestSamples {
  bool has_news(std::uint32_t) = delete;
};

struct WithoutNoise : FewestSamples {
  template <Refiner R>
  bool notice_noise(const BlockView<R>&) = delete;
};

static_assert(BlockMeasure<FewestSamples, MeanRefiner>);
static_assert(BlockMeasure<ChangeMeasure, MeanRefiner>);
static_assert(BlockMeasure<ResidualMeasure, MeanRefiner>);
static_assert(!BlockMeasure<WithoutPriority, MeanRefiner>);
static_assert(!BlockMeasure<WithoutNoise, MeanRefiner>);
static_assert(!BlockMeasure<WithoutUnits, MeanRefiner>);
static_assert(!BlockMeasure<WithoutNews, MeanRefiner>);
static_assert(!BlockMeasure<MeanRefiner, MeanRefiner>);

// --------------------------------------------------------------------------------- the engine with
// it

constexpr std::size_t width = 37, height = 21, channels = 2;

/// Two channels, of which the second is the first one seen from the other side.
std::array<float, channels> sample(double x, double y) {
  return {helpers::picture(x, y), 3 - 2 * helpers::picture(y, x)};
}

using Blocks = BlockStore<MeanRefiner>;

template <class M>
M measure_of(std::size_t blocks, std::size_t most) {
  if constexpr (std::is_same_v<M, FewestSamples>) {
    return M();
  } else {
    return M(PrioritySettings{}, blocks, most);
  }
}

template <class M>
Engine<MeanRefiner, M> make_engine(std::size_t wave, std::size_t most = 1000) {
  const BlockGrid grid = BlockGrid::of(width, height, channels);
  return {grid, Blocks(MeanRefiner(helpers::shared_list(), channels), grid.size(), most),
          measure_of<M>(grid.size(), most), std::vector<float>(grid.size(), 1), wave};
}

/// The host's loop. Calls look(request) before each sample.
template <class E, class Sample, class Look>
void serve(E& engine, std::size_t at_once, const Sample& of, const Look& look) {
  std::vector<Request> requests(at_once);
  while (const std::size_t count = engine.request(requests)) {
    std::vector<float> values;
    for (const Request& request : std::span(requests).first(count)) {
      look(request);
      for (const float value : of(request.x, request.y)) values.push_back(value);
    }
    engine.deliver(std::span(requests).first(count), values);
  }
}

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
