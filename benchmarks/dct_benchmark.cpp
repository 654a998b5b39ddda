// SPDX-License-Identifier: MIT
// Inverse transform of one 8 x 8 block of coefficients.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#ifdef FREQSYNTH_BENCH_FFTW
#include <fftw3.h>
#endif

#include "freqsynth/basis/dct.h"

namespace freqsynth::bench {
namespace {

struct Block {
  alignas(32) std::array<float, max_terms> values;

  Block() {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (float& value : values) value = normal(random);
  }
};

void library(benchmark::State& state) {
  const Block coefficients;
  Block pixels;
  const auto terms = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    inverse_dct(coefficients.values, pixels.values, terms);
    benchmark::DoNotOptimize(pixels.values);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(library)->Name("inverse_dct/freqsynth")->ArgName("terms")->Arg(64)->Arg(16);

/// Textbook loops: rows, then columns, on amplitudes in zig-zag order like the library.
void plain_loops(benchmark::State& state) {
  std::array<std::array<float, block_size>, block_size> cosine;  // [u][x]
  for (std::size_t u = 0; u < block_size; ++u) {
    for (std::size_t x = 0; x < block_size; ++x) {
      const double angle = static_cast<double>((2 * x + 1) * u) * std::numbers::pi / 16;
      cosine[u][x] = static_cast<float>(std::cos(angle));
    }
  }
  benchmark::DoNotOptimize(cosine);
  const Block coefficients;
  Block pixels;
  for (auto _ : state) {
    float amplitudes[block_size][block_size];  // [v][u]
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      amplitudes[f.v][f.u] =
          coefficients.values[i] * static_cast<float>(amplitude_of_coefficient(i));
    }
    float rows[block_size][block_size] = {};  // [v][x]
    for (std::size_t v = 0; v < block_size; ++v) {
      for (std::size_t u = 0; u < block_size; ++u) {
        for (std::size_t x = 0; x < block_size; ++x) rows[v][x] += amplitudes[v][u] * cosine[u][x];
      }
    }
    pixels.values.fill(0);
    for (std::size_t y = 0; y < block_size; ++y) {
      for (std::size_t v = 0; v < block_size; ++v) {
        for (std::size_t x = 0; x < block_size; ++x) {
          pixels.values[y * block_size + x] += rows[v][x] * cosine[v][y];
        }
      }
    }
    benchmark::DoNotOptimize(pixels.values);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(plain_loops)->Name("inverse_dct/plain_loops");

#ifdef FREQSYNTH_BENCH_FFTW
/// The transform alone: its input is in rows and scaled already, which the others do themselves.
void fftw(benchmark::State& state) {
  Block amplitudes;
  Block pixels;
  constexpr int size = block_size;
  const fftwf_plan plan =
      fftwf_plan_r2r_2d(size, size, amplitudes.values.data(), pixels.values.data(), FFTW_REDFT01,
                        FFTW_REDFT01, FFTW_PATIENT | FFTW_PRESERVE_INPUT);
  amplitudes = Block();  // planning has overwritten it
  for (auto _ : state) {
    fftwf_execute(plan);
    benchmark::DoNotOptimize(pixels.values);
    benchmark::ClobberMemory();
  }
  fftwf_destroy_plan(plan);
}
BENCHMARK(fftw)->Name("inverse_dct/fftw_transform_alone");
#endif

}  // namespace
}  // namespace freqsynth::bench
