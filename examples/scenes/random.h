// SPDX-License-Identifier: MIT
/// \file
/// Random numbers that depend on nothing but the name of a sample.
#pragma once

#include <cstdint>

namespace scenes {

/// A bijection of the 64-bit numbers that leaves no pattern of its argument visible: the finalizer
/// of SplitMix64 (Steele, Lea and Flood 2014).
constexpr std::uint64_t mix_bits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

/// A short sequence of random numbers for one sample.
class Random {
 public:
  /// Any seed, any id; the sequences of different pairs are independent.
  constexpr Random(std::uint64_t seed, std::uint64_t id) : state_(mix_bits(mix_bits(seed) + id)) {}

  /// Uniform in [0, 1).
  constexpr double uniform() {
    state_ += 0x9e3779b97f4a7c15u;
    return static_cast<double>(mix_bits(state_) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace scenes
