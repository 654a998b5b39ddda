// SPDX-License-Identifier: MIT
// A renderer with threads of its own: they fetch positions and bring values, whoever is free, while
// another thread looks at the picture as it grows.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include "freqsynth/freqsynth.h"

static float trace(const freqsynth::Request& ray) {
  return static_cast<float>(0.5 + 0.5 * std::cos(0.002 * (ray.x * ray.x + ray.y * ray.y)));
}

static void render(freqsynth::Synthesizer& engine, const std::atomic<bool>& cancelled) {
  std::vector<freqsynth::Request> rays;
  std::vector<float> values;
  while (!cancelled) {
    rays.resize(64);
    rays.resize(engine.request(rays));
    if (rays.empty()) {
      // Either a stop rule holds, or the others still owe the rest of the wave. Empty: they have
      // just brought it.
      const auto reason = engine.stopped();
      if (reason && reason != freqsynth::StopReason::waiting) return;
      std::this_thread::yield();
      continue;
    }
    values.clear();
    for (const freqsynth::Request& ray : rays) {
      if (cancelled) break;
      values.push_back(trace(ray));
    }
    // What is not traced goes back, so that nothing is owed when we leave.
    const auto done = std::span<const freqsynth::Request>(rays).first(values.size());
    engine.deliver(done, values);
    engine.give_back(std::span<const freqsynth::Request>(rays).subspan(values.size()));
  }
}

int main() {
  freqsynth::Synthesizer engine({.width = 320, .height = 240, .channels = 1});
  engine.set_stop({.samples_per_pixel = 2});

  std::atomic<bool> cancelled = false;
  std::atomic<int> at_work = 3;
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      render(engine, cancelled);
      --at_work;
    });
  }
  std::size_t previews = 0;
  while (at_work > 0) {
    const auto preview = freqsynth::reconstruct(engine.image());  // of the completed waves
    previews += preview.size() == 320 * 240;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (std::thread& thread : threads) thread.join();

  const auto pixels = freqsynth::reconstruct(engine.finished_image());
  std::printf("%llu samples, %zu previews, %zu pixels\n",
              static_cast<unsigned long long>(engine.stats().samples), previews, pixels.size());
}
