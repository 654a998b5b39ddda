// SPDX-License-Identifier: MIT
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/refine/literal_refiner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "support/oracles.h"
#include "support/refiner_helpers.h"

namespace freqsynth {
namespace {

using helpers::Block;
using helpers::Coefficients;
using helpers::expect_near;
using helpers::shared_list;
using helpers::tolerance;
using helpers::widened;
using oracle::float_rounding;
using oracle::Real;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(LeastSquaresRefiner, IsTheLeastSquaresFitAfterEverySample) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block block(refiner);
  oracle::LeastSquares expected;
  oracle::Random random(1);
  while (block.samples() < 450) {
    const SequencePosition position = block.next();
    const float value = random.value();
    block.add({value});
    expected.add(position.s, position.t, value);
    const std::size_t terms = shared_list()->terms(block.samples() - 1);
    ASSERT_NO_FATAL_FAILURE(
        expect_near(block.coefficients(), expected.coefficients(terms), tolerance(block.samples())))
        << block.samples() << " samples";
  }
}

TEST(LeastSquaresRefiner, EqualsTheLiteralPath) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block block(refiner);
  LiteralRefiner literal(shared_list());
  oracle::Random random(2);
  while (block.samples() < 1000) {
    const float value = random.value();
    block.add({value});
    literal.absorb(value);
    const auto amplitudes = literal.amplitudes();
    std::vector<Real> expected(max_terms);
    for (std::size_t i = 0; i < amplitudes.size(); ++i) {
      expected[i] = static_cast<Real>(amplitudes[i]) / oracle::amplitude(i);
    }
    ASSERT_NO_FATAL_FAILURE(
        expect_near(block.coefficients(), expected, tolerance(block.samples())));
  }
}

TEST(LeastSquaresRefiner, SamplesTogetherAreThoseOneByOneToTheBit) {
  constexpr std::size_t samples = 300;
  for (const std::size_t channels : {1u, 2u, 3u, 4u, 5u, 9u}) {
    for (const std::size_t bad_until : {0u, 1u, 50u, 300u}) {
      const LeastSquaresRefiner refiner(shared_list(), channels);
      oracle::Random random(static_cast<unsigned>(1000 * channels + bad_until));
      std::vector<float> values(samples * channels);
      for (float& value : values) value = random.value();
      // One channel has no usable value for long.
      for (std::size_t i = 0; i < bad_until * channels; ++i) {
        if (random.below(10) < 1 || i % channels == channels / 2) values[i] = nan;
      }
      detail::AlignedVector<float> together(refiner.state_size()), single(refiner.state_size());
      refiner.reset(together.data());
      refiner.reset(single.data());
      std::vector<float> changes(samples), expected(samples);
      for (std::size_t n = 0; n < samples; ++n) {
        expected[n] = refiner.absorb(single.data(), n, values.data() + n * channels);
      }
      for (std::size_t n = 0; n < samples;) {
        // Some go from one part of the list to the next.
        const std::size_t count = std::min(1 + random.below(40), samples - n);
        refiner.absorb(together.data(), n, values.data() + n * channels,
                       std::span(changes).subspan(n, count));
        n += count;
      }
      const auto same = [](float a, float b) {
        return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
      };
      EXPECT_TRUE(std::equal(together.begin(), together.end(), single.begin(), same))
          << channels << " channels, bad until " << bad_until;
      EXPECT_TRUE(std::equal(changes.begin(), changes.end(), expected.begin(), same));
    }
  }
}

TEST(LiteralRefiner, IsTheLeastSquaresFit) {
  LiteralRefiner literal(shared_list());
  oracle::LeastSquares expected;
  oracle::Random random(3);
  for (std::size_t n = 0; n < 300; ++n) {
    const SequencePosition& position = shared_list()->position(n);
    const double value = random.uniform(-1, 1);
    literal.absorb(value);
    expected.add(position.s, position.t, value);
    const auto amplitudes = expected.amplitudes(shared_list()->terms(n));
    ASSERT_EQ(literal.amplitudes().size(), amplitudes.size());
    for (std::size_t i = 0; i < amplitudes.size(); ++i) {
      // A hundred roundings of Y and J^-1 with a condition number below 15.
      ASSERT_NEAR(literal.amplitudes()[i], static_cast<double>(amplitudes[i]), 1e-12);
    }
  }
}

/// Samples a function and checks that its coefficients are exact as soon as all of them are in.
void expect_exact(const Coefficients& function, std::size_t last_term, double scale) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block block(refiner);
  while (block.samples() < 260) {
    const SequencePosition& position = block.next();
    block.add({static_cast<float>(oracle::block_value(function, position.s, position.t))});
    if (shared_list()->terms(block.samples() - 1) > last_term) {
      ASSERT_NO_FATAL_FAILURE(
          expect_near(block.coefficients(), widened(function), scale * tolerance(block.samples())))
          << block.samples() << " samples";
    }
  }
}

TEST(LeastSquaresRefiner, IsExactForEveryTermOfTheBasis) {
  for (std::size_t term = 0; term < max_terms; ++term) {
    Coefficients function{};
    function[term] = static_cast<float>(1 / oracle::amplitude(term));
    ASSERT_NO_FATAL_FAILURE(expect_exact(function, term, 1)) << "term " << term;
  }
}

TEST(LeastSquaresRefiner, IsExactForCombinationsOfTerms) {
  oracle::Random random(4);
  for (const std::size_t terms : {2u, 5u, 17u, 40u, 64u}) {
    Coefficients function{};
    double scale = 0;
    for (std::size_t i = 0; i < terms; ++i) {
      function[i] = random.value();
      scale += std::abs(double{function[i]}) * static_cast<double>(oracle::amplitude(i));
    }
    ASSERT_NO_FATAL_FAILURE(expect_exact(function, terms - 1, scale)) << terms << " terms";
  }
}

TEST(LeastSquaresRefiner, ConstantInIsConstantOut) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  for (const float value : {1.0f, -0.3f, 7e-3f, 250.0f}) {
    Block block(refiner);
    std::vector<Real> expected(max_terms);
    expected[0] = 8 * static_cast<Real>(value);
    while (block.samples() < 400) {
      EXPECT_LE(block.add({value}), std::pow(value * tolerance(block.samples()), 2));
      ASSERT_NO_FATAL_FAILURE(expect_near(block.coefficients(), expected,
                                          std::abs(value) * tolerance(block.samples())));
    }
  }
}

TEST(LeastSquaresRefiner, IsLinear) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block first(refiner), second(refiner), sum(refiner);
  oracle::Random random(5);
  while (sum.samples() < 300) {
    const float a = random.value(), b = random.value();
    first.add({a});
    second.add({b});
    sum.add({0.5f * a - 0.25f * b});
    std::vector<Real> expected(max_terms);
    for (std::size_t i = 0; i < max_terms; ++i) {
      expected[i] = Real{0.5} * static_cast<Real>(first.coefficients()[i]) -
                    Real{0.25} * static_cast<Real>(second.coefficients()[i]);
    }
    ASSERT_NO_FATAL_FAILURE(
        expect_near(sum.coefficients(), expected, 2 * tolerance(sum.samples())));
  }
}

TEST(LeastSquaresRefiner, ScalesExactlyByPowersOfTwo) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block block(refiner), large(refiner);
  oracle::Random random(6);
  for (int n = 0; n < 200; ++n) {
    const float value = random.value();
    const float change = block.add({value});
    EXPECT_EQ(large.add({1024 * value}), 1024 * 1024 * change);
    for (std::size_t i = 0; i < max_terms; ++i) {
      ASSERT_EQ(large.coefficients()[i], 1024 * block.coefficients()[i]);
    }
  }
}

TEST(LeastSquaresRefiner, ReturnsTheMeanSquaredChangeOfThePixels) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block block(refiner);
  oracle::Random random(7);
  EXPECT_EQ(block.add({random.value()}), 0) << "the first value has nothing to change";
  while (block.samples() < 250) {
    const Coefficients before = block.coefficients();
    const float change = block.add({random.value()});
    const Real expected = oracle::mean_squared_pixel_change(before, block.coefficients());
    // Root mean squares: a few roundings of the result, and of coefficients that are differenced.
    const double root = std::sqrt(static_cast<double>(expected));
    ASSERT_NEAR(std::sqrt(change), root, 16 * float_rounding * root + tolerance(16))
        << block.samples() << " samples";
  }
}

TEST(LeastSquaresRefiner, ChannelsAreIndependentAndWeighted) {
  const std::vector<float> weights = {0.5f, 2, 0};
  const LeastSquaresRefiner one(shared_list(), 1, {1}), three(shared_list(), 3, weights);
  const LeastSquaresRefiner equal(shared_list(), 3);
  std::vector<Block> alone(3, Block(one));
  Block together(three), unweighted(equal);
  oracle::Random random(8);
  for (int n = 0; n < 250; ++n) {
    const std::vector<float> values = {random.value(), 100 * random.value(), random.value()};
    const float change = together.add(values);
    const float mean = unweighted.add(values);
    double weighted = 0, sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double own = alone[c].add({values[c]});
      weighted += own * double{weights[c]};
      sum += own;
      ASSERT_EQ(together.coefficients(c), alone[c].coefficients());
      ASSERT_EQ(unweighted.coefficients(c), alone[c].coefficients());
    }
    EXPECT_NEAR(change, weighted, 8 * float_rounding * weighted);
    EXPECT_NEAR(mean, sum / 3, 8 * float_rounding * sum);
  }
}

TEST(LeastSquaresRefiner, OneObjectServesManyBlocks) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block first(refiner), second(refiner), undisturbed(refiner);
  oracle::Random random(9);
  for (int n = 0; n < 200; ++n) {
    const float value = random.value();
    first.add({value});
    if (n % 3 == 0) second.add({random.value()});
    undisturbed.add({value});
  }
  EXPECT_EQ(first.coefficients(), undisturbed.coefficients());
}

TEST(LeastSquaresRefiner, WrongSettingsAreNamed) {
  const auto list = shared_list();
  EXPECT_THAT([] { LeastSquaresRefiner(SharedInverseList(), 1); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("list")));
  EXPECT_THAT([&] { LeastSquaresRefiner(list, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("channels is 0")));
  EXPECT_THAT(
      [&] {
        LeastSquaresRefiner(list, 3, {1, 2});
      },
      ThrowsMessage<std::invalid_argument>(
          AllOf(HasSubstr("weights"), HasSubstr("2"), HasSubstr("3"))));
  EXPECT_THAT(
      [&] {
        LeastSquaresRefiner(list, 2, {1, -2});
      },
      ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("weights"), HasSubstr("-2"))));
  EXPECT_THAT(
      [&] {
        LeastSquaresRefiner(list, 2, {1, nan});
      },
      ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("weights"), HasSubstr("nan"))));
}

}  // namespace
}  // namespace freqsynth
