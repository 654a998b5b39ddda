// SPDX-License-Identifier: MIT
// How long a thread that renders is kept waiting while another one makes a preview of 1920 x 1080
// pixels, RGB: the image of the fit, a finished one, finished pixels. A turn is a request of 1024
// samples, their values and their delivery. The time of a case is the longest turn that began
// during a preview, as the mean of the previews; the counters are in milliseconds: the longest of
// all, the mean turn without a preview, the mean preview. Needs two processors.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <span>
#include <thread>
#include <vector>

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

  /// \return the seconds that it took
  double turn() {
    const auto start = Clock::now();
    const auto asked = std::span<const Request>(requests_).first(engine_.request(requests_));
    const auto values = std::span(values_).first(asked.size() * engine_.channels());
    DiscScene{}(asked, values);
    engine_.deliver(asked, values);
    return seconds_between(start, Clock::now());
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
  double alone = 0;
  for (int i = 0; i < turns; ++i) alone += renderer.turn();

  double longest = 0, previews = 0;
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
    double worst = 0;
    while (!done) worst = std::max(worst, renderer.turn());
    viewer.join();
    state.SetIterationTime(worst);
    longest = std::max(longest, worst);
    previews += preview_seconds;
  }
  state.counters["longest_ms"] = 1e3 * longest;
  state.counters["alone_ms"] = 1e3 * alone / turns;
  state.counters["preview_ms"] =
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
