// SPDX-License-Identifier: MIT
/// \file
/// Owen-scrambled Sobol points, for the random decisions of a host's samples: where on the lens,
/// which point of the light. The samples of a pixel that take such points, each the next one, have
/// much less noise than with random numbers.
///
/// freqsynth itself does not use them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/mix_bits.h"

namespace freqsynth {

/// Number of dimensions of Sobol points.
inline constexpr unsigned sobol_dimensions = 16;

namespace detail {

/// What a dimension of Sobol's sequence is made of: a primitive polynomial modulo 2, its
/// coefficients but the first and the last in the bits of `middle`, and as many free odd numbers.
struct SobolRecipe {
  unsigned degree;
  std::uint32_t middle;
  std::array<std::uint32_t, 6> initial;
};

/// Those of Joe and Kuo (Constructing Sobol sequences with better two-dimensional projections,
/// 2008). Dimension 0 has no polynomial.
inline constexpr std::array<SobolRecipe, sobol_dimensions> sobol_recipes = {{
    {0, 0, {}},
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
}};

/// What each bit of an index adds to a coordinate, as fractions of 2^32: the direction numbers.
using SobolDirections = std::array<std::uint32_t, 32>;

/// The direction numbers of a dimension, by Sobol's recurrence.
[[nodiscard]] constexpr SobolDirections sobol_directions_of(const SobolRecipe& recipe) {
  SobolDirections v{};
  const unsigned s = recipe.degree;
  for (unsigned k = 0; k < 32; ++k) {
    if (s == 0 || k < s) {
      v[k] = (s == 0 ? 1 : recipe.initial[k]) << (31 - k);
      continue;
    }
    v[k] = v[k - s] ^ (v[k - s] >> s);
    for (unsigned j = 1; j < s; ++j) {
      if ((recipe.middle >> (s - 1 - j) & 1) != 0) v[k] ^= v[k - j];
    }
  }
  return v;
}

/// The direction numbers of all dimensions.
inline constexpr auto sobol_directions = [] {
  std::array<SobolDirections, sobol_dimensions> all{};
  for (unsigned d = 0; d < sobol_dimensions; ++d) all[d] = sobol_directions_of(sobol_recipes[d]);
  return all;
}();

/// Coins for the binary digits of a number, the first digit in the highest bit: each depends on the
/// digits before its own and on the key, on nothing else. `coins` has those of the digits up to the
/// first 1.
///
/// The digits before a coin's own name a node of a binary tree. From the root or from behind any 1
/// on, the nodes that are reached by zeros only take their coins from the same hash, a bit each. So
/// no two nodes share a coin, and there is only one hash for each 1.
[[nodiscard]] constexpr std::uint32_t owen_coins(std::uint32_t digits, std::uint64_t key,
                                                 std::uint32_t coins) {
  for (std::uint32_t rest = digits; rest != 0;) {
    const std::uint32_t one = std::bit_floor(rest);
    const std::uint32_t below = one - 1;
    const auto hash = static_cast<std::uint32_t>(mix_bits(key ^ (digits & ~below)) >> 32);
    coins = (coins & ~below) | (hash & below);
    rest ^= one;
  }
  return coins;
}

}  // namespace detail

/// A coordinate of the point `index` of Sobol's sequence (1967), as a fraction of 2^32.
/// \param dimension  below sobol_dimensions
[[nodiscard]] constexpr std::uint32_t sobol(std::uint32_t index, unsigned dimension) {
  FREQSYNTH_ASSERT(dimension < sobol_dimensions);
  std::uint32_t bits = 0;
  for (; index != 0; index &= index - 1) {
    bits ^= detail::sobol_directions[dimension][static_cast<std::size_t>(std::countr_zero(index))];
  }
  return bits;
}

/// Owen's scrambling of a fraction of 2^32 (Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences,
/// 1995), by its definition: each digit is inverted or not by a coin of its own for each value of
/// the digits before it. The coins are hashes of `key`, all of whose bits should be well mixed.
[[nodiscard]] constexpr std::uint32_t owen_scrambled(std::uint32_t fraction, std::uint64_t key) {
  const auto first = static_cast<std::uint32_t>(detail::mix_bits(key) >> 32);
  return fraction ^ detail::owen_coins(fraction, key, first);
}

/// An Owen-scrambled Sobol point in 16 dimensions, of a sequence that is another one for each pixel
/// and seed. 5 to 20 ns a value for the first hundred points.
///
/// With the ordinals 0 .. 2^m - 1 of a pixel every dimension has a value in each of the intervals
/// of length 2^-m, and the dimensions 0 and 1 together have one in each rectangle of area 2^-m
/// whose sides are powers of two. Other pairs of dimensions are that even only when there are some
/// dozens of points. So decisions that matter are best given dimensions 0 and 1, with a seed each:
/// sequences of different seeds are independent. Their points also come in an order of their own
/// within each of the runs 0, 1, 2..3, 4..7, 8..15, ...
///
/// The sequences of different pixels are independent, too.
class OwenSobol {
 public:
  /// \param pixel    names the pixel, as Request::pixel does
  /// \param ordinal  of the sample in its pixel, as Request::ordinal
  /// \param seed     any; for other sets of points, and for other frames
  constexpr OwenSobol(std::uint64_t pixel, std::uint32_t ordinal, std::uint64_t seed = 0)
      : key_(detail::mix_bits(detail::mix_bits(pixel) +
                              detail::mix_bits(seed + detail::golden_step))),
        index_(ordinal ^ detail::owen_coins(ordinal, key_, 0)) {}

  /// The value of a dimension as a fraction of 2^32. \param dimension  below sobol_dimensions
  [[nodiscard]] constexpr std::uint32_t bits(unsigned dimension) const {
    return owen_scrambled(sobol(index_, dimension), key_ + (dimension + 1) * detail::golden_step);
  }
  /// The value of a dimension, in (0, 1). As a float it may be 1: see as_float().
  /// \param dimension  below sobol_dimensions
  [[nodiscard]] constexpr double operator()(unsigned dimension) const {
    return (bits(dimension) + 0.5) * 0x1p-32;
  }
  /// The same in [0, 1), rounded down. \param dimension  below sobol_dimensions
  [[nodiscard]] constexpr float as_float(unsigned dimension) const {
    return static_cast<float>(bits(dimension) >> 8) * 0x1p-24f;
  }

 private:
  std::uint64_t key_;
  std::uint32_t index_;
};

}  // namespace freqsynth
