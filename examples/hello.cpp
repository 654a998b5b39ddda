// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>

#include "freqsynth/freqsynth.h"

int main() {
  // Any function of a position in pixels: here a disc with a soft shadow.
  auto radiance = [](double x, double y) {
    const double distance = std::hypot(x - 128, y - 128);
    return distance < 80 ? 1.0 : 0.5 - 0.5 * std::exp(-distance / 80);
  };
  freqsynth::Synthesizer engine({.width = 256, .height = 256, .channels = 1});
  engine.run(radiance, {.samples_per_pixel = 0.5});

  std::ofstream file("hello.pgm", std::ios::binary);
  file << "P5 256 256 255\n";
  for (const float value : freqsynth::reconstruct(engine.finished_image())) {
    file.put(static_cast<char>(std::lround(255 * std::fmin(std::fmax(value, 0), 1))));
  }
  return file ? 0 : 1;
}
