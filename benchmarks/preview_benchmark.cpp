// SPDX-License-Identifier: MIT
// How long a thread that renders is kept waiting while another one makes a preview of 1920 x 1080
// pixels, RGB: the image of the fit, a finished one, finished pixels. A turn is a request of 1024
// samples, their values and their delivery. The time of a case is the longest request or delivery
// that began during a preview, on the clock, as the mean of the previews: with other programs
// about, mostly time that the system gave to these. The counters, in milliseconds, tell them apart,
// see call_times.h: `wait` are requests and deliveries during previews, `alone` those before them,
// and `sampling` the values, which wait for nobody: what is lost there is lost to other programs.
// `preview` is the mean preview. Needs two processors.

#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <span>
#include <thread>
#include <vector>

#include "call_times.h"
#include "fixtures.h"

namespace freqsynth::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// A renderer that asks 1024 samples at a time.
class Renderer {
 public:
  explicit Renderer(Synthesizer& engine)
      : engine_(engine), requests_(1024), values_(requests_.size() * engine.channels()) {
    engine_.set_stop({});
  }

  void turn(CallTimes& calls, CallTimes& sampling) {
    const std::span<const Request> asked = std::span<const Request>(requests_).first(
        calls.measure([&] { return engine_.request(requests_); }));
    const auto values = std::span(values_).first(asked.size() * engine_.channels());
    sampling.measure([&] {
      DiscScene{}(asked, values);
      return asked.size();
    });
    calls.measure([&] {
      engine_.deliver(asked, values);
      return asked.size();
    });
  }

 private:
  Synthesizer& engine_;
  std::vector<Request> requests_;
  std::vector<float> values_;
};

/// \param look  makes a preview
template <class Look>
void preview(benchmark::State& state, const Look& look) {
  const auto engine = sampled_engine(1920, 1080, 0.25);
  Renderer renderer(*engine);
  constexpr int turns = 1000;
  CallTimes alone, waits, sampling;
  for (int i = 0; i < turns; ++i) renderer.turn(alone, sampling);

  double previews = 0;
  for (auto _ : state) {
    std::atomic<bool> begun = false, done = false;
    double preview_seconds = 0;
    std::jthread viewer([&] {
      const auto start = Clock::now();
      begun = true;
      look(*engine);
      preview_seconds = seconds_between(start, Clock::now());
      done = true;
    });
    while (!begun) std::this_thread::yield();
    CallTimes own;
    while (!done) renderer.turn(own, sampling);
    viewer.join();
    state.SetIterationTime(own.longest());
    waits.add(own);
    previews += preview_seconds;
  }
  waits.report(state, "wait");
  alone.report(state, "alone");
  sampling.report(state, "sampling");
  state.counters["preview"] =
      benchmark::Counter(1e3 * previews, benchmark::Counter::kAvgIterations);
}

void image(benchmark::State& state) {
  preview(state, [](const Synthesizer& engine) {
    const FrequencyImage result = engine.image();
    benchmark::DoNotOptimize(result.coefficients(0, 0, 0)[0]);
  });
}
void finished_image(benchmark::State& state) {
  preview(state, [](const Synthesizer& engine) {
    const FrequencyImage result = engine.finished_image();
    benchmark::DoNotOptimize(result.coefficients(0, 0, 0)[0]);
  });
}
void finish(benchmark::State& state) {
  std::vector<float> pixels(std::size_t{1920} * 1080 * 3);
  preview(state, [&](const Synthesizer& engine) {
    engine.finish({pixels.data(), 1920, 1080});
    benchmark::DoNotOptimize(pixels.data());
  });
}
#define FREQSYNTH_PREVIEW(function)               \
  BENCHMARK(function)                             \
      ->Name("preview/1920x1080/turn/" #function) \
      ->Iterations(10)                            \
      ->UseManualTime()                           \
      ->Unit(benchmark::kMillisecond)
FREQSYNTH_PREVIEW(image);
FREQSYNTH_PREVIEW(finished_image);
FREQSYNTH_PREVIEW(finish);

}  // namespace
}  // namespace freqsynth::bench
