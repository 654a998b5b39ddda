// SPDX-License-Identifier: MIT
// Construction of the list that all images share, from nothing, one thread. `per_entry` is the time
// divided by the number of entries.

#include <benchmark/benchmark.h>

#include <cstddef>

#include "freqsynth/basis/inverse_list.h"

namespace freqsynth::bench {
namespace {

void build(benchmark::State& state) {
  const auto entries = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    const InverseList list;
    list.reserve(entries);
    benchmark::DoNotOptimize(list.gain(entries - 1).data());
  }
  state.counters["per_entry"] = benchmark::Counter(
      static_cast<double>(entries),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(build)
    ->Name("inverse_list/build")
    ->ArgName("entries")
    ->Arg(256)
    ->Arg(4096)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freqsynth::bench
