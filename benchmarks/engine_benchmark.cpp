// SPDX-License-Identifier: MIT
// Cost of the engine per RGB sample, one thread, at 1 sample per pixel of a scene that costs next
// to nothing. The time of a case is that of the construction, the run and the frequency image
// together; the counters, in nanoseconds per sample, are the parts of it. `core` is what the engine
// itself says that run() spent outside of the sampler.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fixtures.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// \param list  of its own: the engine builds it
enum class List { shared, own };

SynthesisSettings settings_of(const benchmark::State& state, List list) {
  SynthesisSettings settings = sharing_settings(static_cast<std::size_t>(state.range(0)),
                                                static_cast<std::size_t>(state.range(1)));
  if (list == List::own) settings.shared_list = {};
  return settings;
}

StopRule one_per_pixel() {
  StopRule stop;
  stop.samples_per_pixel = 1;
  return stop;
}

template <List list>
void engine(benchmark::State& state) {
  const SynthesisSettings settings = settings_of(state, list);
  double construction = 0, core = 0, sampling = 0, result = 0;
  std::uint64_t samples = 0, absorbed = 0, waves = 0;
  for (auto _ : state) {
    const auto t0 = Clock::now();
    Synthesizer synthesizer(settings);
    const auto t1 = Clock::now();
    const RunReport report = synthesizer.run(DiscScene{}, one_per_pixel());
    const auto t2 = Clock::now();
    const FrequencyImage image = synthesizer.image();
    const auto t3 = Clock::now();
    benchmark::DoNotOptimize(image.coefficients(0, 0, 0)[0]);
    state.SetIterationTime(seconds_between(t0, t3));
    construction += seconds_between(t0, t1);
    result += seconds_between(t2, t3);
    core += report.core_seconds;
    sampling += report.sampler_seconds;
    const SynthesisStats stats = synthesizer.stats();
    samples += stats.samples;
    absorbed += stats.absorbed;
    waves = stats.waves;
  }
  const auto count = static_cast<double>(samples);
  state.counters["core_ns_per_sample"] = 1e9 * core / count;
  state.counters["construct_ns_per_sample"] = 1e9 * construction / count;
  state.counters["image_ns_per_sample"] = 1e9 * result / count;
  state.counters["sampler_ns_per_sample"] = 1e9 * sampling / count;
  state.counters["ns_per_sample"] = 1e9 * (construction + core + sampling + result) / count;
  state.counters["absorbed_per_sample"] = static_cast<double>(absorbed) / count;
  state.counters["waves"] = static_cast<double>(waves);
}

BENCHMARK(engine<List::shared>)
    ->Name("engine/shared_list")
    ->ArgNames({"width", "height"})
    ->Args({256, 256})
    ->Args({512, 512})
    ->Args({1024, 1024})
    ->Args({1920, 1080})
    ->Args({3840, 2160})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(engine<List::own>)
    ->Name("engine/own_list")
    ->ArgNames({"width", "height"})
    ->Args({512, 512})
    ->Args({1920, 1080})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// An engine that has done nothing yet; its end is not counted.
void construction(benchmark::State& state) {
  const SynthesisSettings settings = settings_of(state, List::shared);
  for (auto _ : state) {
    const auto start = Clock::now();
    Synthesizer synthesizer(settings);
    state.SetIterationTime(seconds_between(start, Clock::now()));
    benchmark::DoNotOptimize(&synthesizer);
  }
}
BENCHMARK(construction)
    ->Name("engine/construction")
    ->ArgNames({"width", "height"})
    ->Args({1920, 1080})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Sets the peak of the resident memory back to the present (Linux; nothing elsewhere).
void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// Peak of the resident memory in MB (10^6 bytes), or what is resident now (VmHWM, VmRSS); 0 where
/// it is not known.
double memory_of(std::string_view kind) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0;
    if (word.substr(0, 5) == kind && status >> kilobytes) return kilobytes * 1024 / 1e6;
  }
  return 0;
}

/// From an empty engine to the finished picture, with engine and pixels alive at the end. The
/// peak is the whole process's: run this case alone (--benchmark_filter=peak_memory) for an honest
/// number. `program_MB` is what there is before the engine, `finish_MB` what finishing takes beside
/// the engine and the picture.
void memory(benchmark::State& state) {
  double program = 0, finish = 0, peak = 0;
  for (auto _ : state) {
    reset_peak_memory();
    program = memory_of("VmRSS");
    Synthesizer synthesizer(settings_of(state, List::own));
    synthesizer.run(DiscScene{}, one_per_pixel());
    const SynthesisSettings& settings = synthesizer.settings();
    std::vector<float> pixels(settings.width * settings.height * settings.channels);
    const double before = memory_of("VmHWM");
    synthesizer.finish({pixels.data(), settings.width, settings.height});
    benchmark::DoNotOptimize(pixels.data());
    peak = memory_of("VmHWM");
    finish = peak - before;
  }
  state.counters["program_MB"] = program;
  state.counters["finish_MB"] = finish;
  state.counters["peak_MB"] = peak;
}
BENCHMARK(memory)
    ->Name("engine/peak_memory")
    ->ArgNames({"width", "height"})
    ->Args({1920, 1080})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freqsynth::bench
