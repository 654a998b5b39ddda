// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/picture.h"

/// A fractal: octaves of noise, each of twice the frequency and `gain` times the amplitude.
struct Fractal {
  int octaves = 1;
  double gain = 0.5;
  std::uint64_t seed = 0;
};

/// View of a mountainside before a sky of one colour; RGB display values in 0..255.
Picture mountainside(const Fractal& fractal, std::size_t width, std::size_t height);
