// SPDX-License-Identifier: MIT
#include "freqsynth/freqsynth.h"

const char* version_of_other_unit();
float mean_of_other_unit();

const char* version_of_other_unit() { return FREQSYNTH_VERSION; }

float mean_of_other_unit() {
  freqsynth::FrequencyImage image(8, 8, 1);
  image.coefficients(0, 0, 0)[0] = 8;
  return freqsynth::reconstruct(image)[0];
}
