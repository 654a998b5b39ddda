// SPDX-License-Identifier: MIT
#include "freqsynth/basis/owen_sobol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "freqsynth/basis/mix_bits.h"
#include "support/is_net.h"

namespace freqsynth {
namespace {

using Pair = std::array<std::uint32_t, 2>;

// --------------------------------------------------------------------- Sobol, by the definition

/// A polynomial modulo 2, the coefficient of x^i in bit i.
using Polynomial = std::uint64_t;

/// The published polynomials in full, and the numbers that are free to choose.
struct Definition {
  Polynomial polynomial;
  std::vector<std::uint64_t> initial;
};
const std::vector<Definition> definitions = {
    {0b11, {1}},
    {0b111, {1, 3}},
    {0b1011, {1, 3, 1}},
    {0b1101, {1, 1, 1}},
    {0b10011, {1, 1, 3, 3}},
    {0b11001, {1, 3, 5, 13}},
    {0b100101, {1, 1, 5, 5, 17}},
    {0b101001, {1, 1, 5, 5, 5}},
    {0b101111, {1, 1, 7, 11, 19}},
    {0b110111, {1, 1, 5, 1, 1}},
    {0b111011, {1, 1, 1, 3, 11}},
    {0b111101, {1, 3, 5, 5, 31}},
    {0b1000011, {1, 3, 3, 9, 7, 49}},
    {0b1011011, {1, 1, 1, 15, 21, 21}},
    {0b1100001, {1, 3, 1, 13, 27, 49}},
};

unsigned degree(Polynomial p) { return static_cast<unsigned>(std::bit_width(p)) - 1; }

/// x^power modulo p, by so many multiplications with x.
Polynomial power_of_x(std::uint64_t power, Polynomial p) {
  Polynomial rest = 1;
  for (; power > 0; --power) {
    rest <<= 1;
    if (degree(rest) == degree(p)) rest ^= p;
  }
  return rest;
}

/// A coordinate by the definition: the sum modulo 2 of m_k / 2^k over the digits of the index,
/// where m_k follows from the numbers before it. Each m_k is a number, not shifted to any place.
std::uint32_t slow_sobol(std::uint32_t index, unsigned dimension) {
  std::vector<std::uint64_t> m;
  if (dimension == 0) {
    m.assign(33, 1);
  } else {
    const Definition& definition = definitions[dimension - 1];
    const unsigned s = degree(definition.polynomial);
    m = definition.initial;
    m.insert(m.begin(), 0);  // counted from 1
    while (m.size() < 33) {
      const std::size_t k = m.size();
      std::uint64_t next = m[k - s];
      for (unsigned j = 1; j <= s; ++j) {
        const bool coefficient = (definition.polynomial >> (s - j) & 1) != 0;
        if (coefficient) next ^= m[k - j] * (std::uint64_t{1} << j);
      }
      m.push_back(next);
    }
  }
  std::uint64_t sum = 0;
  for (unsigned k = 1; k <= 32; ++k) {
    if ((index >> (k - 1) & 1) != 0) sum ^= m[k] * (std::uint64_t{1} << (32 - k));
  }
  return static_cast<std::uint32_t>(sum);
}

TEST(Sobol, PolynomialsArePrimitiveAndFreeNumbersAllowed) {
  ASSERT_EQ(definitions.size() + 1, sobol_dimensions);
  std::set<Polynomial> distinct;
  for (const Definition& definition : definitions) {
    const Polynomial p = definition.polynomial;
    distinct.insert(p);
    const std::uint64_t order = (std::uint64_t{1} << degree(p)) - 1;
    for (std::uint64_t power = 1; power < order; ++power) {
      EXPECT_NE(power_of_x(power, p), 1u) << p << ' ' << power;
    }
    if (order > 1) {
      EXPECT_EQ(power_of_x(order, p), 1u) << p;
    }
    ASSERT_EQ(definition.initial.size(), degree(p));
    for (std::size_t k = 0; k < definition.initial.size(); ++k) {
      EXPECT_EQ(definition.initial[k] % 2, 1u);
      EXPECT_LT(definition.initial[k], std::uint64_t{2} << k);
    }
  }
  EXPECT_EQ(distinct.size(), definitions.size());
}

TEST(Sobol, IsThatOfTheDefinition) {
  std::mt19937 random(1);
  for (unsigned d = 0; d < sobol_dimensions; ++d) {
    for (std::uint32_t index = 0; index < 300; ++index) {
      ASSERT_EQ(sobol(index, d), slow_sobol(index, d)) << d << ' ' << index;
    }
    for (int i = 0; i < 300; ++i) {
      const auto index = static_cast<std::uint32_t>(random());
      ASSERT_EQ(sobol(index, d), slow_sobol(index, d)) << d << ' ' << index;
    }
  }
}

TEST(Sobol, TheFirstPairIsThatOfPascalsTriangle) {
  // An independent definition of dimension 1: digit i is the sum of binomial(k, i) times digit k of
  // the index; the binomial is odd where the digits of i are among those of k.
  for (std::uint32_t index = 0; index < 4096; ++index) {
    std::uint32_t mirrored = 0, pascal = 0;
    for (unsigned i = 0; i < 12; ++i) {
      unsigned digit = 0;
      for (unsigned k = i; k < 12; ++k) digit ^= (index >> k & 1) & ((i & k) == i ? 1u : 0u);
      mirrored |= (index >> i & 1) << (31 - i);
      pascal |= digit << (31 - i);
    }
    ASSERT_EQ(sobol(index, 0), mirrored);
    ASSERT_EQ(sobol(index, 1), pascal);
  }
}

// --------------------------------------------------------------------------------- nets

/// Whether each interval of length 2^-m holds one of the 2^m values.
bool is_stratified(std::span<const std::uint32_t> values, unsigned m) {
  std::set<std::uint64_t> cells;
  for (const std::uint32_t value : values) cells.insert(std::uint64_t{value} >> (32 - m));
  return cells.size() == values.size();
}

TEST(OwenSobol, EveryPrefixOfAPowerOfTwoIsStratified) {
  for (unsigned m = 0; m <= 9; ++m) {
    for (std::uint64_t pixel = 0; pixel < 12; ++pixel) {
      std::vector<Pair> points;
      std::array<std::vector<std::uint32_t>, sobol_dimensions> values;
      for (std::uint32_t i = 0; i < (1u << m); ++i) {
        const OwenSobol point(pixel, i, 77);
        points.push_back({point.bits(0), point.bits(1)});
        for (unsigned d = 0; d < sobol_dimensions; ++d) values[d].push_back(point.bits(d));
      }
      ASSERT_TRUE(helpers::is_net(points, m)) << m << ' ' << pixel;
      for (unsigned d = 0; d < sobol_dimensions; ++d) {
        ASSERT_TRUE(is_stratified(values[d], m)) << m << ' ' << pixel << ' ' << d;
      }
    }
  }
}

TEST(OwenSobol, SoIsEveryRunThatStartsAtAMultipleOfItsLength) {
  // Of those that are within the same power of two, whose order is shuffled.
  for (const auto& [first, m] : {Pair{8, 3}, Pair{12, 2}, Pair{20, 2}, Pair{48, 4}, Pair{96, 5}}) {
    for (std::uint64_t pixel = 0; pixel < 12; ++pixel) {
      std::vector<Pair> points;
      for (std::uint32_t i = 0; i < (1u << m); ++i) {
        const OwenSobol point(pixel, first + i);
        points.push_back({point.bits(0), point.bits(1)});
      }
      ASSERT_TRUE(helpers::is_net(points, m)) << first << ' ' << pixel;
    }
  }
}

TEST(OwenSobol, ValuesAreWithinTheirIntervals) {
  double least = 1, most = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const OwenSobol point(3, i);
    for (unsigned d = 0; d < sobol_dimensions; ++d) {
      least = std::min(least, point(d));
      most = std::max(most, point(d));
      EXPECT_GE(point.as_float(d), 0.0f);
      EXPECT_LT(point.as_float(d), 1.0f);
      EXPECT_NEAR(double{point.as_float(d)}, point(d), 0x1p-24);
    }
  }
  EXPECT_GT(least, 0);
  EXPECT_LT(least, 1e-3);
  EXPECT_LT(most, 1);
  EXPECT_GT(most, 1 - 1e-3);
}

// ------------------------------------------------------------------------- Owen's scrambling

TEST(Owen, ScramblesEachDigitByThoseAboveItAlone) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto a = static_cast<std::uint32_t>(random());
    // Equal above a digit, different there.
    const unsigned digit = static_cast<unsigned>(random() % 32);
    const auto b = static_cast<std::uint32_t>(a ^ (std::uint32_t{1} << digit) ^
                                              (random() & ((std::uint32_t{1} << digit) - 1)));
    const std::uint32_t difference = owen_scrambled(a, 5) ^ owen_scrambled(b, 5);
    ASSERT_EQ(std::bit_width(difference), std::bit_width(a ^ b)) << a << ' ' << b;
  }
}

/// The coin of the node that the first `depth` digits of `path` name.
bool coin(std::uint32_t path, unsigned depth, std::uint64_t key) {
  const std::uint32_t fraction = depth == 0 ? 0 : path & ~((std::uint32_t{1} << (32 - depth)) - 1);
  return ((owen_scrambled(fraction, key) ^ fraction) >> (31 - depth) & 1) != 0;
}

TEST(Owen, CoinsOfAllNodesAreFairAndIndependent) {
  // Of the 127 nodes of the first seven levels, over keys: fair, and of each two equal in half of
  // all cases. The deviation of a share of 4096 is 1/128; six of them are allowed to one of 8000.
  constexpr int keys = 4096;
  std::vector<std::vector<bool>> coins;
  for (unsigned depth = 0; depth < 7; ++depth) {
    for (std::uint32_t node = 0; node < (1u << depth); ++node) {
      std::vector<bool> of_node;
      for (std::uint64_t k = 0; k < keys; ++k) {
        const std::uint32_t path = depth == 0 ? 0 : node << (32 - depth);
        of_node.push_back(coin(path, depth, detail::mix_bits(k + 1)));
      }
      coins.push_back(of_node);
    }
  }
  ASSERT_EQ(coins.size(), 127u);
  for (std::size_t a = 0; a < coins.size(); ++a) {
    EXPECT_NEAR(static_cast<double>(std::count(coins[a].begin(), coins[a].end(), true)), keys / 2,
                6 * 32)
        << a;
    for (std::size_t b = 0; b < a; ++b) {
      int equal = 0;
      for (std::size_t k = 0; k < keys; ++k) equal += coins[a][k] == coins[b][k];
      EXPECT_NEAR(equal, keys / 2, 6 * 32) << a << ' ' << b;
    }
  }
}

TEST(Owen, CoinsFarDownAreFair) {
  constexpr int keys = 4096;
  for (const std::uint32_t path : {0u, 0x12345678u, 0xfffffffeu, 0x80000000u}) {
    for (unsigned depth = 7; depth < 32; ++depth) {
      int ones = 0;
      for (std::uint64_t k = 0; k < keys; ++k) ones += coin(path, depth, detail::mix_bits(k + 1));
      EXPECT_NEAR(ones, keys / 2, 6 * 32) << path << ' ' << depth;
    }
  }
}

// ------------------------------------------------------------------ as a host integrates with it

/// Mean over pixels of the squared error of means over the first `count` samples.
template <class Function>
double squared_error(std::uint32_t count, double truth, Function&& function) {
  constexpr std::uint64_t pixels = 4000;
  double sum = 0;
  for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
    double mean = 0;
    for (std::uint32_t k = 0; k < count; ++k) mean += function(pixel, k) / count;
    sum += (mean - truth) * (mean - truth) / pixels;
  }
  return sum;
}

TEST(OwenSobol, MeansAreUnbiasedAndGetBetterFasterThanRandomOnes) {
  // A smooth function of two dimensions, whose mean is 1/4 and variance 1/9 - 1/16 = 7/144.
  const auto product = [](std::uint64_t pixel, std::uint32_t k) {
    const OwenSobol point(pixel, k, 3);
    return point(0) * point(1);
  };
  double mean = 0;
  for (std::uint64_t pixel = 0; pixel < 20000; ++pixel) mean += product(pixel, 5) / 20000;
  EXPECT_NEAR(mean, 0.25, 5 * std::sqrt(7.0 / 144 / 20000));
  EXPECT_NEAR(squared_error(1, 0.25, product), 7.0 / 144, 0.1 * 7 / 144);
  // Of n points about 1 / n^3, not 1 / n.
  EXPECT_LT(squared_error(4, 0.25, product), 7.0 / 144 / 16);
  EXPECT_LT(squared_error(16, 0.25, product), 7.0 / 144 / 16 / 40);
}

TEST(OwenSobol, SequencesOfTwoSeedsAreIndependent) {
  // Where two scrambled copies of the same sequence would go through the square together, the error
  // of a product of functions of one each would not fall: it is that of independent points here.
  const auto sign = [](double value) { return value < 0.5 ? -1.0 : 1.0; };
  const auto quarter = [](double value) { return std::fmod(value, 0.5) < 0.25 ? -1.0 : 1.0; };
  for (const std::uint32_t count : {4u, 16u}) {
    const double of_halves = squared_error(count, 0, [&](std::uint64_t pixel, std::uint32_t k) {
      return sign(OwenSobol(pixel, k, 1)(0)) * sign(OwenSobol(pixel, k, 2)(0));
    });
    EXPECT_LT(of_halves, 2.2 / count) << count;
    const double of_quarters = squared_error(count, 0, [&](std::uint64_t pixel, std::uint32_t k) {
      return quarter(OwenSobol(pixel, k, 1)(0)) * quarter(OwenSobol(pixel, k, 2)(0));
    });
    EXPECT_LT(of_quarters, 2.2 / count) << count;
  }
}

TEST(OwenSobol, PixelsSeedsAndDimensionsDiffer) {
  std::set<std::uint32_t> values;
  for (std::uint64_t pixel = 0; pixel < 20; ++pixel) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      for (unsigned d = 0; d < sobol_dimensions; ++d) {
        values.insert(OwenSobol(pixel, 0, seed).bits(d));
      }
    }
  }
  // Of 6400 numbers of 32 bits two are equal once in 200 times.
  EXPECT_GE(values.size(), 6399u);
}

static_assert(OwenSobol(1, 2, 3)(4) > 0, "may be used at compile time");

}  // namespace
}  // namespace freqsynth
