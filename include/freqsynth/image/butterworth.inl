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
    const double d = std::hypot(f.u, f.v);
    factors[i] = static_cast<float>(1 / (1 + std::pow(d / cutoff, 2 * settings.order)));
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

}  // namespace detail

}  // namespace freqsynth
