// SPDX-License-Identifier: MIT
// What an engine of 1920 x 1080 pixels, RGB, at 1 sample per pixel takes to hand out its result,
// one thread: the coefficients of the fit, and finished pixels.

#include <benchmark/benchmark.h>

#include <vector>

#include "fixtures.h"
#include "freqsynth/image/reconstructor.h"

namespace freqsynth::bench {
namespace {

const Synthesizer& full_hd() {
  static const auto engine = sampled_engine(1920, 1080, 1);
  return *engine;
}

void image(benchmark::State& state) {
  for (auto _ : state) {
    forget_free_memory(state);
    const FrequencyImage result = full_hd().image();
    benchmark::DoNotOptimize(result.coefficients(0, 0, 0)[0]);
  }
}
BENCHMARK(image)->Name("result/1920x1080/image")->Unit(benchmark::kMillisecond);

void finished_image(benchmark::State& state, const FinishSettings& settings) {
  for (auto _ : state) {
    forget_free_memory(state);
    const FrequencyImage result = full_hd().finished_image(settings);
    benchmark::DoNotOptimize(result.coefficients(0, 0, 0)[0]);
  }
}
BENCHMARK_CAPTURE(finished_image, exact, FinishSettings{})
    ->Name("result/1920x1080/finished_image")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(finished_image, noisy, FinishSettings{.noise = Noise::present})
    ->Name("result/1920x1080/finished_image_noisy")
    ->Unit(benchmark::kMillisecond);

/// All that the shortest program does after its run.
void pixels(benchmark::State& state) {
  for (auto _ : state) {
    forget_free_memory(state);
    const std::vector<float> result = reconstruct(full_hd().finished_image());
    benchmark::DoNotOptimize(result.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(pixels)->Name("result/1920x1080/finished_pixels")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freqsynth::bench
