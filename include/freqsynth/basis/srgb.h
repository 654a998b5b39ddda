// SPDX-License-Identifier: MIT
/// \file
/// The transfer function of sRGB (IEC 61966-2-1), on 0..1.
#pragma once

#include <cmath>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// Of a linear value in 0..1.
template <class Real>
[[nodiscard]] Real srgb_of_linear(Real x) {
  return x <= Real(0.0031308) ? Real(12.92) * x
                              : Real(1.055) * std::pow(x, 1 / Real(2.4)) - Real(0.055);
}

/// Its inverse.
template <class Real>
[[nodiscard]] Real linear_of_srgb(Real x) {
  return x <= Real(0.04045) ? x / Real(12.92)
                            : std::pow((x + Real(0.055)) / Real(1.055), Real(2.4));
}

}  // namespace freqsynth::detail
