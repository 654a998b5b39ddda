// SPDX-License-Identifier: MIT
// run() on a pool of the host's own, with an end after a time, an exception and bad samples.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <limits>
#include <stdexcept>
#include <vector>

#include "freqsynth/freqsynth.h"

// The host's pool, here the one behind std::async. A task never throws, each is run exactly once,
// and execute() returns when all are done.
struct HostPool {
  static std::size_t concurrency() { return 4; }
  static void execute(std::size_t count, freqsynth::TaskRef task) {
    std::vector<std::future<void>> jobs;
    for (std::size_t first = 0; first < count; first += (count + 3) / 4) {
      const std::size_t last = std::min(count, first + (count + 3) / 4);
      jobs.push_back(std::async(std::launch::async, [=] {
        for (std::size_t i = first; i < last; ++i) task(i);
      }));
    }
    for (std::future<void>& job : jobs) job.get();
  }
};

int main() {
  bool broken = true;  // as a texture that is not there yet
  const auto radiance = [&](double x, double y) {
    if (broken && x > 100) throw std::runtime_error("no texture");
    if (x < 1 && y < 1) return std::numeric_limits<double>::quiet_NaN();
    return 0.5 + 0.5 * std::sin(x * y / 500);
  };
  freqsynth::Synthesizer engine({.width = 200, .height = 150, .channels = 1});
  const freqsynth::StopRule stop{.samples_per_pixel = 1, .seconds = 60};  // what comes first

  try {
    engine.run(radiance, stop, HostPool{});
  } catch (const std::runtime_error& error) {
    std::printf("stopped by \"%s\"; what was sampled is kept\n", error.what());
    broken = false;
  }

  double told = 0;
  const auto report = engine.run(radiance, stop, HostPool{}, [&](const freqsynth::Progress& now) {
    if (now.fraction >= told + 0.25) {
      told = now.fraction;
      std::fprintf(stderr, "%.0f %%, %.1f s left\n", 100 * now.fraction, now.seconds_left);
    }
    return true;  // false: run() returns, and can go on later
  });
  std::printf("%s, %llu samples\n",
              report.reason == freqsynth::StopReason::samples ? "all samples" : "out of time",
              static_cast<unsigned long long>(engine.stats().samples));
  for (const freqsynth::BadSample& bad : engine.bad_samples()) {
    std::printf("not a number at (%g, %g)\n", bad.x, bad.y);
  }
}
