// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/check.h"

namespace freqsynth::detail {

FREQSYNTH_INLINE void refuse(const std::string& what) {
  throw std::invalid_argument("freqsynth: " + what);
}

FREQSYNTH_INLINE void refuse_value(const char* name, double value, const char* range) {
  refuse(std::string(name) + " is " + to_text(value) + ", not " + range);
}

FREQSYNTH_INLINE std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace freqsynth::detail
