// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <vector>

#include "freqsynth/freqsynth.h"

// A renderer with a loop of its own: it traces rays in bunches, here in the shape of a function.
static void trace(const std::vector<freqsynth::Request>& rays, std::vector<float>& rgb) {
  rgb.resize(3 * rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double rings =
        0.5 + 0.5 * std::cos(0.001 * (rays[i].x * rays[i].x + rays[i].y * rays[i].y));
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = static_cast<float>(rings);
  }
}

int main() {
  freqsynth::Synthesizer engine({.width = 320, .height = 240, .channels = 3});
  engine.set_stop({.samples_per_pixel = 0.25});

  std::vector<freqsynth::Request> rays(512);
  std::vector<float> rgb;
  while (const std::size_t count = engine.request(rays)) {  // 0: see engine.stopped()
    rays.resize(count);
    trace(rays, rgb);
    engine.deliver(rays, rgb);  // in any order and portions, from any thread
    rays.resize(512);
  }

  // The result is a function: here its mean over each pixel of an image of twice the size.
  const std::vector<float> pixels = freqsynth::reconstruct(engine.finished_image(), {}, 2);
  std::printf("%zu values from %llu rays\n", pixels.size(),
              static_cast<unsigned long long>(engine.stats().samples));
}
