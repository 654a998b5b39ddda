// SPDX-License-Identifier: MIT
/// \file
/// No block stays behind the others for good, however flat it looks: what is small and lies between
/// the first samples of a block would never be found.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// The blocks that have fewer samples than every block should have by now: the first whole number
/// above m^exponent, when the blocks have m on average; above m itself up to a given number.
class Exploration {
 public:
  /// \param exponent  see PrioritySettings::exploration
  /// \param blocks    how many there are
  /// \param first     so many samples go to every block before errors decide
  Exploration(double exponent, std::size_t blocks, std::size_t first = 0)
      : exponent_(exponent), first_(static_cast<double>(first)), blocks_(blocks) {
    if (any()) lagging_.reserve(blocks);
  }

  /// Finds the blocks that lag when that number has grown, or when those that were found last have
  /// all been visited; so all blocks are looked at about twice in a sample of each. Does not
  /// allocate.
  /// \param mean   samples of a block, on average
  /// \param lags   lags(block, n): whether a block has fewer than its share of n samples
  template <class Lags>
  void update(double mean, Lags&& lags);

  /// Calls take(block) for blocks that lag until it returns false or there is none.
  template <class Lags, class Take>
  void visit(Lags&& lags, Take&& take);

  /// Whether all blocks are to have the same number of samples.
  [[nodiscard]] bool even() const { return exponent_ == 1 || least_ < first_; }
  /// Samples that every block should have by now.
  [[nodiscard]] double least() const { return least_; }

 private:
  friend struct StateArchive;

  [[nodiscard]] bool any() const { return exponent_ > 0 || first_ > 0; }

  double exponent_, first_;
  std::size_t blocks_;
  double least_ = 0;
  std::vector<std::uint32_t> lagging_;
  std::size_t next_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

template <class Lags>
void Exploration::update(double mean, Lags&& lags) {
  if (!any()) return;
  double least = exponent_ > 0 ? std::floor(std::pow(mean, exponent_)) + 1 : 0;
  least = std::fmax(least, std::fmin(std::floor(mean) + 1, first_));
  // Those that lag by more than one come again.
  const bool taken = next_ > 0 && next_ == lagging_.size();
  if (least <= least_ && !taken) return;
  least_ = least;
  next_ = 0;
  lagging_.clear();
  for (std::uint32_t block = 0; block < blocks_; ++block) {
    if (lags(block, least_)) lagging_.push_back(block);
  }
}

template <class Lags, class Take>
void Exploration::visit(Lags&& lags, Take&& take) {
  for (; next_ < lagging_.size(); ++next_) {
    const std::uint32_t block = lagging_[next_];
    if (lags(block, least_) && !take(block)) return;
  }
}

}  // namespace freqsynth
