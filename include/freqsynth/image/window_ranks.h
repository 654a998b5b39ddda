// SPDX-License-Identifier: MIT
/// \file
/// Values of a moving window by their rank.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// Some of the numbers below a limit, of which the k-th is asked for again and again while a few
/// come and go.
class WindowRanks {
 public:
  explicit WindowRanks(std::size_t limit) : words_(limit / bits + 1) {}

  void add(std::size_t number) {
    words_[number / bits] |= bit(number);
    before_ += number / bits < word_ ? 1 : 0;
  }
  void remove(std::size_t number) {
    words_[number / bits] &= ~bit(number);
    before_ -= number / bits < word_ ? 1 : 0;
  }
  /// The number that `rank` of those here are less than; there are more than that.
  [[nodiscard]] std::size_t of_rank(std::size_t rank) {
    while (before_ > rank) before_ -= count(words_[--word_]);
    while (before_ + count(words_[word_]) <= rank) before_ += count(words_[word_++]);
    std::uint64_t word = words_[word_];
    for (std::size_t left = rank - before_; left > 0; --left) word &= word - 1;
    return word_ * bits + static_cast<std::size_t>(std::countr_zero(word));
  }

 private:
  static constexpr std::size_t bits = 64;

  static std::uint64_t bit(std::size_t number) { return std::uint64_t{1} << number % bits; }
  static std::size_t count(std::uint64_t word) {
    return static_cast<std::size_t>(std::popcount(word));
  }

  std::vector<std::uint64_t> words_;
  std::size_t word_ = 0;    // where the last answer was
  std::size_t before_ = 0;  // numbers in the words before that one
};

}  // namespace freqsynth::detail
