// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstring>

#include "freqsynth/freqsynth.h"

const char* version_of_other_unit();
float mean_of_other_unit();

// Prints the version, and only that, when the library works.
int main() {
  freqsynth::Synthesizer engine({.width = 16, .height = 8, .channels = 1});
  engine.run([](double, double) { return 0.25; }, {.samples_per_pixel = 1});
  for (const float value : freqsynth::reconstruct(engine.image())) {
    if (!(value > 0.249f && value < 0.251f)) return 1;
  }
  if (mean_of_other_unit() != 1) return 1;
  std::puts(FREQSYNTH_VERSION);
  return std::strcmp(FREQSYNTH_VERSION, version_of_other_unit()) == 0 ? 0 : 1;
}
