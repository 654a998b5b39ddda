// SPDX-License-Identifier: MIT
#include "freqsynth/engine/steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using oracle::Real;
using Store = BlockStore<LeastSquaresRefiner>;

/// Blocks of random values around levels that are far from each other; some below 0, some above 1.
Store random_blocks(const std::vector<float>& weights, std::size_t count, unsigned seed) {
  Store blocks(LeastSquaresRefiner(helpers::shared_list(), weights.size(), weights), count, 200);
  oracle::Random random(seed);
  for (std::size_t block = 0; block < count; ++block) {
    const double level = std::exp(random.uniform(-7, 1));
    const double spread = level * std::exp(random.uniform(-6, 1));
    const double sign = random.below(5) == 0 ? -1 : 1;
    for (auto n = 1 + random.below(150); n > 0; --n) {
      std::vector<float> values;
      for (std::size_t c = 0; c < weights.size(); ++c) {
        const double factor = std::pow(3.0, static_cast<double>(c));
        values.push_back(
            static_cast<float>(sign * factor * (level + spread * random.uniform(-1, 1))));
      }
      blocks.absorb(block, values.data());
    }
  }
  return blocks;
}

Steering settled(const PrioritySettings& settings, bool noisy, const std::vector<float>& weights,
                 const Store& blocks) {
  Steering steering(settings, noisy, weights, blocks.size());
  EXPECT_FALSE(steering.settled());
  EXPECT_TRUE(steering.absorbed(blocks, 0)) << "all blocks have samples";
  EXPECT_TRUE(steering.settled());
  return steering;
}

/// The 64 pixel centres of the fit: their mean and variance are those of the block's terms.
std::array<Real, 2> moments(const Store& blocks, std::size_t block, std::size_t channel) {
  std::array<float, max_terms> coefficients, pixels;
  blocks.coefficients(block, channel, coefficients);
  inverse_dct(coefficients, pixels);
  Real sum = 0, squares = 0;
  for (const float pixel : pixels) sum += static_cast<Real>(pixel) / 64;
  for (const float pixel : pixels) squares += std::pow(static_cast<Real>(pixel) - sum, 2) / 64;
  const Real unit = std::ldexp(Real{1}, blocks.exponent(channel));
  return {unit * sum, unit * unit * squares};
}

Real srgb(Real linear) {
  if (linear <= 0) return 0;
  if (linear >= 1) return 1;
  if (linear <= Real{0.0031308L}) return Real{12.92L} * linear;
  return Real{1.055L} * std::pow(linear, 1 / Real{2.4L}) - Real{0.055L};
}

/// ln(x + sqrt(x^2 + 1)), whose slope is 1 / sqrt(x^2 + 1).
Real logarithm(Real x) {
  const Real size = std::abs(x);
  return std::copysign(std::log(size + std::sqrt(size * size + 1)), x);
}

/// What is seen of a value: of those of a store of blocks.
class Seen {
 public:
  Seen(const PrioritySettings& settings, const Store& blocks) : settings_(settings) {
    for (std::size_t c = 0; c < blocks.refiner().channels(); ++c) {
      std::vector<Real> sizes;
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (const Real mean = moments(blocks, b, c)[0]; mean != 0) sizes.push_back(std::abs(mean));
      }
      std::sort(sizes.begin(), sizes.end());
      levels_.push_back(sizes.empty() ? 1 : sizes[sizes.size() / 2] / 64);
    }
  }
  Real operator()(Real value, std::size_t channel) const {
    return settings_.steer == Steer::relative ? logarithm(value / levels_[channel])
                                              : srgb(value * static_cast<Real>(settings_.exposure));
  }
  [[nodiscard]] Real level(std::size_t channel) const { return levels_[channel]; }

 private:
  PrioritySettings settings_;
  std::vector<Real> levels_;
};

std::vector<PrioritySettings> steered() {
  PrioritySettings relative, display, exposed;
  relative.steer = Steer::relative;
  display.steer = exposed.steer = Steer::display;
  exposed.exposure = 4;
  return {relative, display, exposed};
}

TEST(Steering, LinearIsNothing) {
  const Store blocks = random_blocks({1}, 3, 1);
  Steering none;
  EXPECT_TRUE(none.linear());
  Steering steering(PrioritySettings{}, false, {1}, 3);
  EXPECT_TRUE(steering.linear());
  for (const PrioritySettings& settings : steered()) {
    EXPECT_FALSE(Steering(settings, false, {1}, 3).linear());
  }
}

TEST(Steering, WeighsResidualsByTheSlopeOfAChord) {
  for (const PrioritySettings& settings : steered()) {
    for (const bool noisy : {false, true}) {
      const std::vector<float> weights{0.5f, 0, 2};
      const Store blocks = random_blocks(weights, 200, 2);
      const Steering steering = settled(settings, noisy, weights, blocks);
      const Seen seen(settings, blocks);
      for (std::uint32_t b = 0; b < blocks.size(); ++b) {
        Real expected = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const auto [mean, variance] = moments(blocks, b, c);
          const auto residual = static_cast<Real>(blocks.residual(b, c));
          const auto n = static_cast<Real>(blocks.samples(b));
          const Real freedom = std::min(static_cast<Real>(blocks.freedom(b)), n);
          // Of a flat fit a tangent, nearly.
          const Real reach = std::max(std::sqrt(variance + (noisy ? 0 : residual * freedom / n)),
                                      Real{1e-8L} * std::abs(mean));
          const Real slope = (seen(mean + reach, c) - seen(mean - reach, c)) / (2 * reach);
          expected += static_cast<Real>(weights[c]) * slope * slope * residual;
        }
        const Real most = settings.steer == Steer::display
                              ? Real{0.25L} * Real{2.5L} * static_cast<Real>(blocks.samples(b)) /
                                    static_cast<Real>(blocks.freedom(b))
                              : std::numeric_limits<Real>::max();
        expected = std::min(expected, most);
        const float found =
            steering.residual(blocks, b, [&](std::size_t c) { return blocks.residual(b, c); });
        // The reach is a sum of squares of floats; flat blocks have chords of another length.
        ASSERT_NEAR(found, static_cast<double>(expected),
                    1e-3 * static_cast<double>(expected) + 1e-9)
            << b;
      }
    }
  }
}

TEST(Steering, OfFlatBlocksItIsTheSlopeItself) {
  for (const PrioritySettings& settings : steered()) {
    Store blocks(LeastSquaresRefiner(helpers::shared_list(), 1), 40, 10);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const auto level = static_cast<float>(1.5 * std::pow(0.8, static_cast<double>(b)));
      blocks.absorb(b, &level);
    }
    const Steering steering = settled(settings, false, {1}, blocks);
    const Seen seen(settings, blocks);
    for (std::uint32_t b = 0; b < blocks.size(); ++b) {
      const Real value = moments(blocks, b, 0)[0];
      const Real shown = value * static_cast<Real>(settings.exposure);
      if (std::abs(shown - Real{0.0031308L}) < Real{1e-4L} || std::abs(shown - 1) < 1e-3) continue;
      Real square = 0;
      if (settings.steer == Steer::relative) {
        square = 1 / (value * value + seen.level(0) * seen.level(0));
      } else if (shown < 1) {
        const Real slope = shown < Real{0.0031308L}
                               ? Real{12.92L}
                               : Real{1.055L} / Real{2.4L} * std::pow(shown, 1 / Real{2.4L} - 1);
        square = std::pow(slope * static_cast<Real>(settings.exposure), 2);
      }
      const float worth = steering.residual(blocks, b, [](std::size_t) { return 1e-6f; });
      EXPECT_NEAR(worth, static_cast<double>(1e-6L * square),
                  1e-4 * static_cast<double>(1e-6L * square))
          << static_cast<double>(value);
    }
  }
}

TEST(Steering, NoResidualIsMoreThanADisplayCanShow) {
  PrioritySettings settings;
  settings.steer = Steer::display;
  const Store blocks = random_blocks({0.5f, 0.5f}, 200, 3);
  const Steering steering = settled(settings, false, {0.5f, 0.5f}, blocks);
  for (std::uint32_t b = 0; b < blocks.size(); ++b) {
    const float most = 0.25f * static_cast<float>(blocks.samples(b)) / blocks.freedom(b);
    for (const float residual : {1.0f, 1e10f, 1e30f}) {
      const float worth = steering.residual(blocks, b, [=](std::size_t) { return residual; });
      ASSERT_GE(worth, 0);
      ASSERT_LE(worth, most * 1.0001f);
    }
  }
}

TEST(Steering, KnowsTheVarianceOfWhatIsSeen) {
  for (const PrioritySettings& settings : steered()) {
    const std::vector<float> weights{0.5f, 0, 2};
    const Store blocks = random_blocks(weights, 200, 4);
    const Steering steering = settled(settings, false, weights, blocks);
    const Seen seen(settings, blocks);
    Real expected = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      Real mean = 0, variance = 0;
      for (std::size_t b = 0; b < 200; ++b) mean += seen(moments(blocks, b, c)[0], c) / 200;
      for (std::size_t b = 0; b < 200; ++b) {
        variance += std::pow(seen(moments(blocks, b, c)[0], c) - mean, 2) / 200;
      }
      expected += static_cast<Real>(weights[c]) * variance;
    }
    EXPECT_NEAR(steering.variance(), static_cast<double>(expected),
                1e-5 * static_cast<double>(expected));
  }
}

TEST(Steering, AChangeOfOneChannelIsWorthWhatAResidualIs) {
  for (const PrioritySettings& settings : steered()) {
    for (const float weight : {1.0f, 3.0f}) {
      const Store blocks = random_blocks({weight}, 100, 5);
      const Steering steering = settled(settings, false, {weight}, blocks);
      for (std::uint32_t b = 0; b < blocks.size(); ++b) {
        const float change = 1e-5f;
        const float expected =
            steering.residual(blocks, b, [&](std::size_t) { return change / weight; });
        EXPECT_NEAR(steering.change(blocks, b, change), expected, 1e-5f * expected);
      }
    }
  }
}

TEST(Steering, UnitsOfTheBlocksDoNotMatter) {
  const std::vector<float> weights{1, 1};
  for (const PrioritySettings& settings : steered()) {
    Store blocks = random_blocks(weights, 50, 6);
    const Steering before = settled(settings, false, weights, blocks);
    std::vector<float> worth;
    for (std::uint32_t b = 0; b < 50; ++b) {
      worth.push_back(before.residual(blocks, b, [&](auto c) { return blocks.residual(b, c); }));
    }
    for (const int exponent : {-40, 20}) {
      const std::array<int, 2> exponents{exponent, exponent / 2};
      blocks.use_units(exponents, std::array<float, 2>{1, std::ldexp(1.0f, -exponent)});
      const Steering after = settled(settings, false, weights, blocks);
      EXPECT_EQ(after.variance(), before.variance());
      for (std::uint32_t b = 0; b < 50; ++b) {
        const auto own = [&](std::size_t c) { return blocks.residual(b, c); };
        EXPECT_EQ(after.residual(blocks, b, own), worth[b]);
        EXPECT_EQ(before.residual(blocks, b, own), worth[b]) << "while it is in use";
      }
    }
  }
}

TEST(Steering, RelativeErrorsHaveNoUnit) {
  PrioritySettings settings;
  settings.steer = Steer::relative;
  std::vector<std::vector<float>> worths;
  for (const float unit : {1.0f, 0x1p-90f, 0x1p90f}) {
    Store blocks(LeastSquaresRefiner(helpers::shared_list(), 1), 30, 100);
    const std::array<int, 1> exponent{std::ilogb(unit)};
    blocks.use_units(exponent, std::array<float, 1>{1});
    oracle::Random random(7);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (int n = 0; n < 60; ++n) {
        const auto value = unit * static_cast<float>(std::exp(random.uniform(-6, 3)));
        blocks.absorb(b, &value);
      }
    }
    const Steering steering = settled(settings, false, {1}, blocks);
    worths.emplace_back();
    for (std::uint32_t b = 0; b < blocks.size(); ++b) {
      worths.back().push_back(
          steering.residual(blocks, b, [&](auto c) { return blocks.residual(b, c); }));
    }
    EXPECT_EQ(worths.back(), worths.front()) << unit;
  }
}

TEST(Steering, LooksAtBlocksThatHaveChanged) {
  for (const PrioritySettings& settings : steered()) {
    Store blocks(LeastSquaresRefiner(helpers::shared_list(), 1), 2, 300);
    const float dark = 0.01f, bright = 0.8f;
    Steering steering(settings, false, {1}, 2);
    blocks.absorb(0, &dark);
    EXPECT_FALSE(steering.absorbed(blocks, 0)) << "nothing is known of the other block";
    blocks.absorb(1, &dark);
    EXPECT_TRUE(steering.absorbed(blocks, 1));
    const auto worth = [&](std::uint32_t b) {
      return steering.residual(blocks, b, [](std::size_t) { return 1e-6f; });
    };
    EXPECT_EQ(worth(0), worth(1));
    const float before = worth(0);
    for (int n = 0; n < 100; ++n) {
      blocks.absorb(1, &bright);
      EXPECT_FALSE(steering.absorbed(blocks, 1)) << "that comes once";
    }
    EXPECT_EQ(worth(0), before);
    EXPECT_LT(worth(1), 0.1f * before);
  }
}

TEST(Steering, MoreSamplesOfAFunctionWithoutNoiseGainLess) {
  const PrioritySettings settings = steered().back();
  const Steering exact(settings, false, {1}, 1), noisy(settings, true, {1}, 1);
  for (const float rate : {0.1f, 1.0f}) EXPECT_EQ(exact.gain(rate), 1);
  EXPECT_FLOAT_EQ(exact.gain(4), 0.25f);
  EXPECT_EQ(noisy.gain(4), 1);
}

TEST(Steering, NoiseThatIsNoticedIsNoiseThatWasKnown) {
  const std::vector<float> weights{0.5f, 2};
  const Store blocks = random_blocks(weights, 20, 3);
  for (const PrioritySettings& settings : steered()) {
    Steering early(settings, false, weights, blocks.size());
    early.notice_noise(blocks);
    EXPECT_TRUE(early.absorbed(blocks, 0));
    Steering late = settled(settings, false, weights, blocks);
    const Steering exact = settled(settings, false, weights, blocks);
    const Steering known = settled(settings, true, weights, blocks);
    late.notice_noise(blocks);
    std::size_t others = 0;
    for (std::uint32_t block = 0; block < blocks.size(); ++block) {
      const auto worth = [&](const Steering& steering) {
        return steering.residual(blocks, block, [](std::size_t) { return 1e-3f; });
      };
      EXPECT_EQ(worth(early), worth(known));
      EXPECT_EQ(worth(late), worth(known));
      others += worth(exact) != worth(known) ? 1 : 0;
    }
    EXPECT_GT(others, 10u);
    EXPECT_EQ(late.gain(4), 1);
  }
}

}  // namespace
}  // namespace freqsynth
