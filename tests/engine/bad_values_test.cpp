// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/sampler.h"
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

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(BadValues, UsableValuesAreFiniteAndNotHuge) {
  for (const float good :
       {0.0f, -0.0f, 1.0f, -5e-40f, 1e10f, max_sample_magnitude, -max_sample_magnitude}) {
    EXPECT_TRUE(is_usable_sample(good)) << good;
  }
  for (const float bad : {nan, -nan, infinity, -infinity, 1e38f, -1e38f,
                          std::nextafter(max_sample_magnitude, infinity)}) {
    EXPECT_FALSE(is_usable_sample(bad)) << bad;
  }
}

TEST(BadValues, LargestStateValuesStayFinite) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  Block block(refiner);
  oracle::Random random(10);
  for (int n = 0; n < 1000; ++n) {
    const float value = random.below(2) == 0 ? most_state_value : -most_state_value;
    ASSERT_TRUE(std::isfinite(block.add({value})));
    for (const float coefficient : block.coefficients()) ASSERT_TRUE(std::isfinite(coefficient));
  }
}

TEST(BadValues, BadValueCountsAsThePrediction) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  const std::vector<float> bad_values = {nan, infinity, -infinity, 1e38f, -3e38f};
  Block block(refiner), predicted(refiner);
  oracle::Random random(11);
  for (int n = 0; n < 300; ++n) {
    const bool bad = n > 0 && random.below(3) == 0;
    const SequencePosition& position = block.next();
    const float prediction =
        static_cast<float>(oracle::block_value(predicted.coefficients(), position.s, position.t));
    const float value = bad ? prediction : random.value();
    const float change = block.add({bad ? bad_values[random.below(bad_values.size())] : value});
    const float expected_change = predicted.add({value});
    EXPECT_NEAR(std::sqrt(change), std::sqrt(expected_change), tolerance(block.samples()));
    // Both blocks round differently; predictions are within the range of the values, about.
    ASSERT_NO_FATAL_FAILURE(expect_near(block.coefficients(), widened(predicted.coefficients()),
                                        4 * tolerance(block.samples())));
  }
}

TEST(BadValues, BadValueInOneChannelLeavesTheOthersAlone) {
  const LeastSquaresRefiner refiner(shared_list(), 3);
  Block block(refiner), clean(refiner);
  oracle::Random random(12);
  for (int n = 0; n < 200; ++n) {
    const std::vector<float> values = {random.value(), random.value(), random.value()};
    clean.add(values);
    block.add({values[0], n % 2 == 0 ? nan : values[1], values[2]});
    ASSERT_EQ(block.coefficients(0), clean.coefficients(0));
    ASSERT_EQ(block.coefficients(2), clean.coefficients(2));
    for (const float coefficient : block.coefficients(1)) ASSERT_TRUE(std::isfinite(coefficient));
  }
}

TEST(BadValues, ChannelWithoutUsableValueIsZero) {
  const LeastSquaresRefiner refiner(shared_list(), 2);
  Block block(refiner);
  EXPECT_EQ(block.coefficients(0), Coefficients{}) << "no sample";
  oracle::Random random(13);
  for (int n = 0; n < 200; ++n) {
    EXPECT_TRUE(std::isfinite(block.add({nan, random.value()})));
    ASSERT_EQ(block.coefficients(0), Coefficients{});
  }
}

TEST(BadValues, EarlierBadSamplesCountAsTheFirstUsableValue) {
  const LeastSquaresRefiner refiner(shared_list(), 1);
  for (const std::size_t bad : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 12u, 40u, 170u}) {
    Block block(refiner), expected(refiner);
    oracle::Random random(static_cast<unsigned>(bad));
    const float first = random.value();
    for (std::size_t n = 0; n < bad; ++n) {
      EXPECT_EQ(block.add({infinity}), 0);
      expected.add({first});
    }
    EXPECT_EQ(block.add({first}), 0) << "the first usable value has nothing to change";
    expected.add({first});
    for (int n = 0; n < 120; ++n) {
      ASSERT_NO_FATAL_FAILURE(expect_near(block.coefficients(), widened(expected.coefficients()),
                                          2 * tolerance(block.samples())))
          << bad << " bad samples, then " << n;
      const float value = random.value();
      block.add({value});
      expected.add({value});
    }
  }
}

}  // namespace
}  // namespace freqsynth
