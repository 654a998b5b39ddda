// SPDX-License-Identifier: MIT
/// \file
/// What terms are expected to hold that no sample has told of yet.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"

namespace freqsynth::detail {

/// Expected energy of the terms when it falls with the third power of the frequency, as that of
/// edges does.
struct EdgeSpectrum {
  std::array<double, max_terms> energy{};  // of each term but the constant one
  std::array<double, max_terms> tail{};    // of it and of all frequencies that come later

  EdgeSpectrum() {
    constexpr std::size_t finest = 64;  // frequencies beyond hold next to nothing
    const auto density = [](std::size_t u, std::size_t v) {
      return std::pow(static_cast<double>(u * u + v * v), -1.5);
    };
    double rest = 0;
    for (std::size_t v = 0; v < finest; ++v) {
      for (std::size_t u = v == 0 ? 1 : 0; u < finest; ++u) rest += density(u, v);
    }
    for (std::size_t i = 1; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      energy[i] = density(f.u, f.v);
      tail[i] = rest;
      rest -= energy[i];
    }
  }
};

inline const EdgeSpectrum& edge_spectrum() {
  static const EdgeSpectrum spectrum;
  return spectrum;
}

}  // namespace freqsynth::detail
