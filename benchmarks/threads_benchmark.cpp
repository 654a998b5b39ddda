// SPDX-License-Identifier: MIT
// What threads gain, at 1 sample per pixel, by the cost of a sample.
//
// threads/wall: run() on a pool of threads. For a machine that has nothing else to do.
//
// threads/model: the same from processor time alone, so that it can be told on a machine that is
// busy, or has fewer cores. The executor has the tasks done one after the other and measures how
// long those of each call take; what is not in a task is serial. It is assumed that the tasks of a
// call are alike, each of the cores takes the next one as soon as it is free, cores do not slow
// each other down, and a call costs nothing more, or 5 us to wake threads (`speedup_5us`).

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <initializer_list>
#include <span>
#include <vector>

#include "fixtures.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// Seconds of processor time that this thread has used.
double thread_seconds() {
#if defined(CLOCK_THREAD_CPUTIME_ID)
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
#else
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
}

/// Work that takes as long as it takes, in steps that depend on each other.
float work(std::size_t steps, float x) {
  for (std::size_t i = 0; i < steps; ++i) x = x * 0.999f + 1e-9f;
  return x;
}

/// Steps of work() in a nanosecond, as the machine is now.
double steps_of_nanosecond() {
  double least = 1e9;
  for (int i = 0; i < 5; ++i) {
    const double begin = thread_seconds();
    benchmark::DoNotOptimize(work(1'000'000, static_cast<float>(i)));
    least = std::min(least, thread_seconds() - begin);
  }
  return 1e6 / (1e9 * least);
}

/// A disc, and so many nanoseconds for each sample.
class CostlyScene {
 public:
  explicit CostlyScene(double nanoseconds)
      : steps_(static_cast<std::size_t>(nanoseconds * steps_of_nanosecond())) {}
  void operator()(std::span<const Request> requests, std::span<float> values) const {
    scene_(requests, values);
    if (steps_ == 0) return;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      // Else compilers do it for several samples at the same time.
      float result = work(steps_, values[3 * i]);
      benchmark::DoNotOptimize(result);
    }
  }

 private:
  DiscScene scene_;
  std::size_t steps_;
};

/// Does everything on the calling thread, and measures what several threads would take.
class ModelExecutor {
 public:
  explicit ModelExecutor(std::size_t threads) : threads_(threads) {}

  void execute(std::size_t count, TaskRef task) {
    const double begin = thread_seconds();
    SerialExecutor::execute(count, task);
    const double time = thread_seconds() - begin;
    const std::size_t turns = (count + threads_ - 1) / threads_;
    parallel_ += time;
    waited_ += time * static_cast<double>(turns) / static_cast<double>(count);
    ++calls_;
  }
  [[nodiscard]] std::size_t concurrency() const { return threads_; }

  /// Seconds of all tasks.
  [[nodiscard]] double parallel() const { return parallel_; }
  /// Seconds that the calls would take.
  [[nodiscard]] double waited() const { return waited_; }
  [[nodiscard]] double calls() const { return static_cast<double>(calls_); }

 private:
  std::size_t threads_;
  std::size_t calls_ = 0;
  double parallel_ = 0, waited_ = 0;
};

SynthesisSettings settings_of(const benchmark::State& state) {
  SynthesisSettings settings = sharing_settings(static_cast<std::size_t>(state.range(0)),
                                                static_cast<std::size_t>(state.range(1)));
  const std::size_t blocks = (settings.width + 7) / 8 * ((settings.height + 7) / 8);
  settings.wave = blocks / static_cast<std::size_t>(state.range(4));
  return settings;
}

StopRule one_per_pixel() {
  StopRule stop;
  stop.samples_per_pixel = 1;
  return stop;
}

/// Seconds of processor time of a run on one thread.
double alone(const SynthesisSettings& settings, const CostlyScene& scene) {
  Synthesizer synthesizer(settings);
  const double begin = thread_seconds();
  synthesizer.run(scene, one_per_pixel());
  return thread_seconds() - begin;
}

void model(benchmark::State& state) {
  const SynthesisSettings settings = settings_of(state);
  const CostlyScene scene(static_cast<double>(state.range(2)));
  const auto threads = static_cast<std::size_t>(state.range(3));
  double one = 0, serial = 0, parallel = 0, several = 0, calls = 0;
  for (auto _ : state) {
    one += alone(settings, scene);
    Synthesizer synthesizer(settings);
    ModelExecutor executor(threads);
    const double begin = thread_seconds();
    synthesizer.run(scene, one_per_pixel(), executor);
    const double rest = thread_seconds() - begin - executor.parallel();
    serial += rest;
    parallel += executor.parallel();
    several += rest + executor.waited();
    calls += executor.calls();
  }
  const double samples = static_cast<double>(state.iterations()) *
                         static_cast<double>(settings.width * settings.height);
  // Both parts have the cost of looking at the clock in them, `one` has not.
  state.counters["ns_alone"] = 1e9 * one / samples;
  state.counters["ns_parallel"] = 1e9 * parallel / samples;
  state.counters["ns_serial"] = 1e9 * serial / samples;
  state.counters["serial_share"] = serial / (serial + parallel);
  state.counters["speedup"] = (serial + parallel) / several;
  state.counters["speedup_5us"] = (serial + parallel) / (several + 5e-6 * calls);
  state.counters["samples_per_call"] = samples / calls;
}

void wall(benchmark::State& state) {
  const SynthesisSettings settings = settings_of(state);
  const CostlyScene scene(static_cast<double>(state.range(2)));
  ThreadPool pool(static_cast<std::size_t>(state.range(3)));
  double one = 0, several = 0;
  const auto seconds = [&](auto&& executor) {
    Synthesizer synthesizer(settings);
    const auto begin = Clock::now();
    synthesizer.run(scene, one_per_pixel(), executor);
    return seconds_between(begin, Clock::now());
  };
  for (auto _ : state) {
    one += seconds(SerialExecutor{});
    const double time = seconds(pool);
    several += time;
    state.SetIterationTime(time);
  }
  const double samples = static_cast<double>(state.iterations()) *
                         static_cast<double>(settings.width * settings.height);
  state.counters["ns_alone"] = 1e9 * one / samples;
  state.counters["ns_together"] = 1e9 * several / samples;
  state.counters["speedup"] = one / several;
}

void sizes(benchmark::internal::Benchmark* cases, std::initializer_list<int> threads) {
  cases->ArgNames({"width", "height", "sampler_ns", "threads", "wave_1_in"});
  for (const auto& [width, height] : {std::array{256, 256}, std::array{1920, 1080}}) {
    for (const int wave : {32, 8}) {
      for (const int cost : {0, 100, 1000}) {
        for (const int count : threads) cases->Args({width, height, cost, count, wave});
      }
    }
  }
}

BENCHMARK(model)->Name("threads/model")->Apply([](auto* cases) {
                                         sizes(cases, {2, 16, 64});
                                       }) -> Unit(benchmark::kMillisecond);
BENCHMARK(wall)->Name("threads/wall")->Apply([](auto* cases) {
                                       sizes(cases, {2});
                                     }) -> UseManualTime() -> Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freqsynth::bench
