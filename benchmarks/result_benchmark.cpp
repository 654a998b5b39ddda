// SPDX-License-Identifier: MIT
// What an engine of 1920 x 1080 pixels, RGB, at 1 sample per pixel takes to hand out its result,
// one thread: the coefficients of the fit, and finished pixels.

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "fixtures.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/image/smooth_noise.h"

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

/// Three channels of noise and seven features.
void smooth(benchmark::State& state) {
  NoisyPicture noisy{1920, 1080, {}, {}, {}, {}, {}};
  const std::size_t pixels = noisy.width * noisy.height;
  noisy.weights.resize(pixels);
  noisy.sums.assign(10, noisy.weights);
  noisy.pixels.assign(10, noisy.weights);
  noisy.variances.assign(10, NoisyPicture::Plane(pixels / max_terms, 0.01f));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (std::size_t i = 0; i < pixels; ++i) {
    noisy.weights[i] = 2 * uniform(random);
    for (std::size_t c = 0; c < 10; ++c) {
      noisy.pixels[c][i] = uniform(random);
      noisy.sums[c][i] = noisy.weights[i] * uniform(random);
    }
  }
  const std::vector<std::size_t> channels = {0, 1, 2}, features = {3, 4, 5, 6, 7, 8, 9};
  for (auto _ : state) {
    state.PauseTiming();
    NoisyPicture picture = noisy;
    state.ResumeTiming();
    smooth_noise(picture, channels, features);
    benchmark::DoNotOptimize(picture.pixels[0].data());
  }
}
BENCHMARK(smooth)->Name("result/1920x1080/smooth_noise_features")->Unit(benchmark::kMillisecond);

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

/// The same into memory that is reused, as a viewer would.
void finish(benchmark::State& state, const FinishSettings& settings) {
  std::vector<float> result(std::size_t{1920} * 1080 * 3);
  for (auto _ : state) {
    full_hd().finish({result.data(), 1920, 1080}, settings);
    benchmark::DoNotOptimize(result.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK_CAPTURE(finish, exact, FinishSettings{})
    ->Name("result/1920x1080/finish")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(finish, noisy, FinishSettings{.noise = Noise::present})
    ->Name("result/1920x1080/finish_noisy")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freqsynth::bench
