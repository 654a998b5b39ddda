// SPDX-License-Identifier: MIT
#define FREQSYNTH_HEADER_ONLY  // nothing to build or link: g++ -std=c++20 -Iinclude single_file.cpp
#include <cmath>
#include <fstream>

#include "freqsynth/freqsynth.h"

int main() {
  auto radiance = [](double x, double y) {  // rings that get finer towards a corner
    return 0.5 + 0.5 * std::cos(0.001 * (x * x + y * y));
  };
  freqsynth::Synthesizer engine({.width = 256, .height = 256, .channels = 1});
  engine.run(radiance, {.samples_per_pixel = 1});

  std::ofstream file("single_file.pgm", std::ios::binary);
  file << "P5 256 256 255\n";
  for (const float value : freqsynth::reconstruct(engine.finished_image())) {
    file.put(static_cast<char>(std::lround(255 * std::fmin(std::fmax(value, 0), 1))));
  }
  return file ? 0 : 1;
}
