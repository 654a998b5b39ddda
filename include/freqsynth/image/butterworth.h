/// \file
/// The Butterworth low-pass filter that removes remaining aliasing (paper, section 4.5). Its cutoff
/// frequency follows the square root of the number of samples of a block.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"

namespace freqsynth {

struct ButterworthSettings {
  bool enabled = true;
  double cutoff = 0.8;  ///< c in d0 = c sqrt(n): half cycles per block; finite and > 0
  double order = 2;     ///< m, finite and > 0

  /// \throws std::invalid_argument naming the field and the value when out of range.
  void validate() const;
};

/// H(u, v) = 1 / (1 + (d / d0)^(2 m)) with d^2 = u^2 + v^2 for each zig-zag term, after `samples`
/// samples. H of the constant term is 1 exactly. All are 1 when the filter is off, and all but the
/// first 0 without samples.
[[nodiscard]] std::array<float, max_terms> butterworth_factors(const ButterworthSettings& settings,
                                                               std::size_t samples);

// ------------------------------------------------------------------------------------ definitions

inline void ButterworthSettings::validate() const {
  const auto check = [](const char* field, double value) {
    if (!(value > 0 && std::isfinite(value))) {
      throw std::invalid_argument("freqsynth: butterworth." + std::string(field) + " is " +
                                  std::to_string(value) + ", not a finite number > 0");
    }
  };
  check("cutoff", cutoff);
  check("order", order);
}

inline std::array<float, max_terms> butterworth_factors(const ButterworthSettings& settings,
                                                        std::size_t samples) {
  std::array<float, max_terms> factors;
  const double cutoff = settings.cutoff * std::sqrt(static_cast<double>(samples));
  for (std::size_t i = 0; i < max_terms; ++i) {
    const Frequency f = frequency_of_term(i);
    const double d = std::hypot(f.u, f.v);
    factors[i] = !settings.enabled || i == 0
                     ? 1.0f
                     : static_cast<float>(1 / (1 + std::pow(d / cutoff, 2 * settings.order)));
  }
  return factors;
}

}  // namespace freqsynth
