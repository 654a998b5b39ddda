// SPDX-License-Identifier: MIT
// A frequency image of 1920 x 1080 pixels, RGB, to interleaved pixels: Butterworth filter, area
// average, one thread. The competitor filters the same coefficients and transforms block by block
// with FFTW, at the image's own size only.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#ifdef FREQSYNTH_BENCH_FFTW
#include <fftw3.h>
#endif

#include "fixtures.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/reconstructor.h"

namespace freqsynth::bench {
namespace {

const FrequencyImage& full_hd() {
  static const FrequencyImage image = sampled_engine(1920, 1080, 1)->image();
  return image;
}

/// Its pixels need no filter.
const FrequencyImage& finished_full_hd() {
  static const FrequencyImage image = sampled_engine(1920, 1080, 1)->finished_image();
  return image;
}

void report(benchmark::State& state, const FrequencyImage& image) {
  const auto blocks = static_cast<double>(image.blocks_x() * image.blocks_y());
  state.counters["per_block"] = benchmark::Counter(
      blocks, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Pixels in memory that is reused, as a viewer would.
struct Frame {
  std::vector<float> pixels;
  PixelView view;

  Frame(const FrequencyImage& image, double scale) {
    view.width = scaled_size(image.width(), scale);
    view.height = scaled_size(image.height(), scale);
    view.pixel_stride = static_cast<std::ptrdiff_t>(image.channels());
    view.row_stride = view.pixel_stride * static_cast<std::ptrdiff_t>(view.width);
    pixels.resize(view.width * view.height * image.channels());
    view.data = pixels.data();
  }
};

void frame(benchmark::State& state, const FrequencyImage& (*get)(), double scale,
           PixelFilter filter) {
  const FrequencyImage& image = get();
  Frame out(image, scale);
  ReconstructionSettings settings;
  settings.pixel_filter = filter;
  for (auto _ : state) {
    reconstruct(image, settings, out.view);
    benchmark::DoNotOptimize(out.pixels.data());
    benchmark::ClobberMemory();
  }
  report(state, image);
}
BENCHMARK_CAPTURE(frame, scale_1, full_hd, 1.0, PixelFilter::box)
    ->Name("reconstruct/1920x1080/scale_1")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, scale_2, full_hd, 2.0, PixelFilter::box)
    ->Name("reconstruct/1920x1080/scale_2")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, scale_half, full_hd, 0.5, PixelFilter::box)
    ->Name("reconstruct/1920x1080/scale_half")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, scale_1_points, full_hd, 1.0, PixelFilter::none)
    ->Name("reconstruct/1920x1080/scale_1_points")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, scale_1_finished, finished_full_hd, 1.0, PixelFilter::box)
    ->Name("reconstruct/1920x1080/scale_1_finished")
    ->Unit(benchmark::kMillisecond);

/// Pixels in new memory, as the shortest program has them.
void fresh_frame(benchmark::State& state) {
  const FrequencyImage& image = full_hd();
  for (auto _ : state) {
    forget_free_memory(state);
    const std::vector<float> pixels = reconstruct(image);
    benchmark::DoNotOptimize(pixels.data());
    benchmark::ClobberMemory();
  }
  report(state, image);
}
BENCHMARK(fresh_frame)
    ->Name("reconstruct/1920x1080/scale_1_fresh_memory")
    ->Unit(benchmark::kMillisecond);

/// One block, tables included: what a call costs at least.
void single_block(benchmark::State& state) {
  const FrequencyImage image = sampled_engine(8, 8, 1)->image();
  Frame out(image, 1);
  for (auto _ : state) {
    reconstruct(image, {}, out.view);
    benchmark::DoNotOptimize(out.pixels.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(single_block)->Name("reconstruct/8x8");

#ifdef FREQSYNTH_BENCH_FFTW
void fftw_frame(benchmark::State& state) {
  const FrequencyImage& image = full_hd();
  Frame out(image, 1);
  const auto sinc = [](double z) {
    return z == 0 ? 1 : std::sin(std::numbers::pi * z) / (std::numbers::pi * z);
  };
  // Butterworth, box, and the scale of FFTW, which counts all but the first term of an axis twice.
  std::vector<std::array<float, max_terms>> factors(2048);
  for (std::size_t n = 0; n < factors.size(); ++n) {
    factors[n] = butterworth_factors({}, n);
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      const double scale = (f.u == 0 ? 1 : 0.5) * (f.v == 0 ? 1 : 0.5);
      factors[n][i] *= static_cast<float>(amplitude_of_coefficient(i) * scale * sinc(f.u / 16.0) *
                                          sinc(f.v / 16.0));
    }
  }
  alignas(32) std::array<float, max_terms> amplitudes{};
  alignas(32) std::array<float, max_terms> values{};
  constexpr int size = block_size;
  const fftwf_plan plan = fftwf_plan_r2r_2d(size, size, amplitudes.data(), values.data(),
                                            FFTW_REDFT01, FFTW_REDFT01, FFTW_PATIENT);
  for (auto _ : state) {
    for (std::size_t by = 0; by < image.blocks_y(); ++by) {
      const std::size_t rows = std::min(block_size, image.height() - by * block_size);
      for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
        const std::size_t columns = std::min(block_size, image.width() - bx * block_size);
        const auto& factor =
            factors[std::min<std::size_t>(image.samples(bx, by), factors.size() - 1)];
        for (std::size_t c = 0; c < image.channels(); ++c) {
          const auto coefficients = image.coefficients(bx, by, c);
          for (std::size_t i = 0; i < max_terms; ++i) {
            const Frequency f = frequency_of_term(i);
            amplitudes[f.v * block_size + f.u] = coefficients[i] * factor[i];
          }
          fftwf_execute(plan);
          for (std::size_t y = 0; y < rows; ++y) {
            float* line =
                out.pixels.data() +
                ((by * block_size + y) * image.width() + bx * block_size) * image.channels() + c;
            for (std::size_t x = 0; x < columns; ++x) {
              line[x * image.channels()] = values[y * block_size + x];
            }
          }
        }
      }
    }
    benchmark::DoNotOptimize(out.pixels.data());
    benchmark::ClobberMemory();
  }
  fftwf_destroy_plan(plan);
  report(state, image);
  // Both must have made the same picture.
  Frame own(image, 1);
  reconstruct(image, {}, own.view);
  float worst = 0;
  for (std::size_t i = 0; i < own.pixels.size(); ++i) {
    worst = std::max(worst, std::abs(own.pixels[i] - out.pixels[i]));
  }
  state.counters["difference"] = double{worst};
  if (!(worst < 1e-4f)) state.SkipWithError("not the same picture");
}
BENCHMARK(fftw_frame)->Name("reconstruct/1920x1080/fftw_scale_1")->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace freqsynth::bench
