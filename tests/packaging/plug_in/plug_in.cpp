// SPDX-License-Identifier: MIT
#include "freqsynth/freqsynth.h"

/// The version of the library, or null when it does not work.
extern "C" __attribute__((visibility("default"))) const char* synthesize() {
  freqsynth::Synthesizer engine({.width = 16, .height = 8, .channels = 1});
  freqsynth::ThreadPool pool(2);
  engine.run([](double, double) { return 0.25; }, {.samples_per_pixel = 1}, pool);
  for (const float value : freqsynth::reconstruct(engine.image())) {
    if (!(value > 0.249f && value < 0.251f)) return nullptr;
  }
  return FREQSYNTH_VERSION;
}
