// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/butterworth.h"

namespace freqsynth {

FREQSYNTH_INLINE void ButterworthSettings::validate() const {
  constexpr const char* range = "a finite number > 0";
  detail::require(detail::is_finite(cutoff) && cutoff > 0, "butterworth.cutoff", cutoff, range);
  detail::require(detail::is_finite(order) && order > 0, "butterworth.order", order, range);
}

FREQSYNTH_INLINE std::array<float, max_terms> butterworth_factors(
    const ButterworthSettings& settings, std::size_t samples) {
  std::array<float, max_terms> factors;
  factors.fill(1);
  if (!settings.enabled) return factors;
  if (samples == 0) {
    std::fill(factors.begin() + 1, factors.end(), 0.0f);
    return factors;
  }
  const double cutoff = settings.cutoff * std::sqrt(static_cast<double>(samples));
  for (std::size_t i = 1; i < max_terms; ++i) {
    const Frequency f = frequency_of_term(i);
    if (f.u > f.v) continue;
    const double d = std::hypot(f.u, f.v);
    factors[i] = factors[term_of_frequency(f.v, f.u)] =
        static_cast<float>(1 / (1 + std::pow(d / cutoff, 2 * settings.order)));
  }
  return factors;
}

namespace detail {

FREQSYNTH_INLINE ButterworthTable::ButterworthTable(const ButterworthSettings& settings,
                                                    const std::array<float, max_terms>& scale)
    : settings_(settings), scale_(scale) {}

FREQSYNTH_INLINE const std::array<float, max_terms>& ButterworthTable::of(std::uint32_t samples) {
  if (!factors_.empty() && samples == last_.samples) return factors_[last_.place];
  const auto fewer = [](const Entry& entry, std::uint32_t count) { return entry.samples < count; };
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), samples, fewer);
  if (entry == entries_.end() || entry->samples != samples) {
    auto factors = butterworth_factors(settings_, samples);
    for (std::size_t i = 0; i < max_terms; ++i) factors[i] *= scale_[i];
    // The entry last: should memory run out, the table is as it was, and a row without an entry.
    const auto place = static_cast<std::uint32_t>(factors_.size());
    factors_.push_back(factors);
    entry = entries_.insert(entry, {samples, place});
  }
  last_ = *entry;
  return factors_[last_.place];
}

FREQSYNTH_INLINE ButterworthFilters::ButterworthFilters(const ButterworthSettings& settings,
                                                        std::span<const std::uint32_t> samples,
                                                        const ExecutorRef& executor,
                                                        std::span<const float> scale) {
  std::uint32_t most = 0;
  for (const std::uint32_t count : samples) most = std::max(most, count);
  places_.resize(std::size_t{most} + 1);
  for (const std::uint32_t count : samples) places_[count] = 1;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t count = 0; count <= most; ++count) {
    if (places_[count] == 0) continue;
    places_[count] = static_cast<std::uint32_t>(numbers.size());
    numbers.push_back(count);
  }
  factors_.resize(numbers.size());
  constexpr std::size_t some = 64;
  share_pieces(executor, (numbers.size() + some - 1) / some, [&](std::size_t piece) {
    for (std::size_t i = piece * some; i < std::min((piece + 1) * some, numbers.size()); ++i) {
      factors_[i] = butterworth_factors(settings, numbers[i]);
      for (std::size_t k = 0; k < scale.size(); ++k) factors_[i][k] *= scale[k];
    }
  });
}

}  // namespace detail

}  // namespace freqsynth
