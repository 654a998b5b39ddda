// SPDX-License-Identifier: MIT
#include <vector>

#include "all_headers.h"

std::vector<float> finish_elsewhere(const freqsynth::Synthesizer& engine);
std::vector<float> render_elsewhere(double (*radiance)(double, double));

std::vector<float> finish_elsewhere(const freqsynth::Synthesizer& engine) {
  return freqsynth::reconstruct(engine.finished_image());
}

std::vector<float> render_elsewhere(double (*radiance)(double, double)) {
  freqsynth::Synthesizer engine({.width = 20, .height = 12, .channels = 1});
  engine.run(radiance, {.samples_per_pixel = 1});
  return finish_elsewhere(engine);
}
