// SPDX-License-Identifier: MIT
/// \file
/// The Butterworth low-pass filter that removes remaining aliasing (paper, section 4.5). Its cutoff
/// frequency follows the square root of the number of samples of a block.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"

namespace freqsynth {

/// The filter's two parameters, and whether there is one.
struct ButterworthSettings {
  bool enabled = true;  ///< false: nothing is filtered
  double cutoff = 0.8;  ///< c in d0 = c sqrt(n): half cycles per block; finite and > 0
  double order = 2;     ///< m, finite and > 0

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate() const;
};

/// H(u, v) = 1 / (1 + (d / d0)^(2 m)) with d^2 = u^2 + v^2 for each zig-zag term, after `samples`
/// samples. H of the constant term is 1 exactly. All are 1 when the filter is off, and all but the
/// first 0 without samples.
[[nodiscard]] FREQSYNTH_API std::array<float, max_terms> butterworth_factors(
    const ButterworthSettings& settings, std::size_t samples);

namespace detail {

/// The factors of all blocks of an image, computed once for each number of samples that occurs.
class ButterworthTable {
 public:
  /// \param scale  another factor per zig-zag term, whatever the number of samples
  ButterworthTable(const ButterworthSettings& settings, const std::array<float, max_terms>& scale);

  /// Filter times scale after `samples` samples; valid until the next call.
  [[nodiscard]] const std::array<float, max_terms>& of(std::uint32_t samples);

 private:
  struct Entry {
    std::uint32_t samples;
    std::uint32_t place;  // in factors_
  };

  ButterworthSettings settings_;
  std::array<float, max_terms> scale_;
  std::vector<Entry> entries_;  // by rising number of samples
  std::vector<std::array<float, max_terms>> factors_;
  Entry last_ = {0, 0};  // neighbours often have the same number
};

/// The factors of several numbers of samples, to be read by several threads.
class FREQSYNTH_API ButterworthFilters {
 public:
  /// Those of all numbers that there are in `samples`.
  /// \param scale  another factor per zig-zag term, whatever the number of samples; empty: 1
  ButterworthFilters(const ButterworthSettings& settings, std::span<const std::uint32_t> samples,
                     const ExecutorRef& executor, std::span<const float> scale = {});

  /// The factors after a number of samples that there was.
  [[nodiscard]] const std::array<float, max_terms>& of(std::uint32_t samples) const {
    return factors_[places_[samples]];
  }

 private:
  std::vector<std::uint32_t> places_;  // by number of samples
  std::vector<std::array<float, max_terms>> factors_;
};

}  // namespace detail

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/butterworth.inl"
#endif
