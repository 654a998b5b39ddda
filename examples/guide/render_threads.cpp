// SPDX-License-Identifier: MIT
// A renderer with threads of its own: they fetch positions and bring values, whoever is free, while
// another thread shows the picture as it grows.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <thread>
#include <vector>

#include "freqsynth/freqsynth.h"

static float trace(const freqsynth::Request& ray) {
  return static_cast<float>(0.5 + 0.5 * std::cos(0.002 * (ray.x * ray.x + ray.y * ray.y)));
}

static void render(freqsynth::Synthesizer& engine) {
  std::vector<freqsynth::Request> rays(16);
  std::vector<float> values;
  // Waits while the others owe the rest of a wave. 0: the end.
  while (const auto count = engine.request(rays, freqsynth::Wait::until_available)) {
    const auto fetched = std::span<const freqsynth::Request>(rays).first(count);
    values.clear();
    for (const freqsynth::Request& ray : fetched) values.push_back(trace(ray));
    engine.deliver(fetched, values);
  }
}

int main() {
  freqsynth::Synthesizer engine({.width = 320, .height = 240, .channels = 1});
  engine.set_stop({.samples_per_pixel = 2, .seconds = 3600});  // whichever comes first

  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back([&] { render(engine); });

  std::uint64_t shown = 0;
  std::size_t previews = 0;
  while (true) {
    const freqsynth::Progress now = engine.progress();
    if (now.revision != shown) {
      shown = now.revision;
      previews += freqsynth::reconstruct(engine.image()).size() == 320 * 240;
    }
    if (now.fraction == 1) break;  // engine.cancel() would end it earlier
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (std::thread& thread : threads) thread.join();

  const auto pixels = freqsynth::reconstruct(engine.finished_image());
  std::printf("%llu samples, %zu previews, %zu pixels\n",
              static_cast<unsigned long long>(engine.stats().samples), previews, pixels.size());
}
