// SPDX-License-Identifier: MIT
// A frequency image of 1920 x 1080 pixels, YCbCr, to the bytes of a JPEG of quality 90, one thread.
// "coefficients" quantises the blocks and codes them; "pixels" reconstructs, rounds to 8 bits and
// hands interleaved YCbCr to libjpeg's compressor, which transforms them back. Tables, subsampling
// and the kind of Huffman codes are the same for both.

#ifdef FREQSYNTH_BENCH_JPEG

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fixtures.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/display_encoding.h"
#include "freqsynth/jpeg/jpeg.h"
#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/synthesizer.h"
#include "pixels_to_jpeg.h"

namespace freqsynth::bench {
namespace {

constexpr int quality = 90;

const FrequencyImage& full_hd() {
  static const FrequencyImage image = [] {
    SynthesisSettings settings;
    settings.width = 1920;
    settings.height = 1080;
    settings.shared_list = prepared_list();
    Synthesizer synthesizer(settings);
    StopRule stop;
    stop.samples_per_pixel = 1;
    synthesizer.run(DisplaySampler<DiscScene>(DiscScene{}, 3), stop);
    return synthesizer.image();
  }();
  return image;
}

QuantizationSettings settings_of(Subsampling subsampling) {
  QuantizationSettings settings;
  settings.luminance = scale_table(luminance_table(), quality);
  settings.chrominance = scale_table(chrominance_table(), quality);
  settings.subsampling = subsampling;
  return settings;
}

void coefficients(benchmark::State& state, Subsampling subsampling, bool optimize) {
  const FrequencyImage& image = full_hd();
  const QuantizationSettings settings = settings_of(subsampling);
  std::size_t size = 0;
  for (auto _ : state) {
    const auto bytes = encode_jpeg(quantize(image, settings), {.optimize = optimize});
    size = bytes.size();
    benchmark::DoNotOptimize(bytes.data());
  }
  state.counters["bytes"] = static_cast<double>(size);
}

/// Quantisation alone.
void quantization(benchmark::State& state, Subsampling subsampling) {
  const FrequencyImage& image = full_hd();
  const QuantizationSettings settings = settings_of(subsampling);
  for (auto _ : state) benchmark::DoNotOptimize(quantize(image, settings).components.data());
}

void pixels(benchmark::State& state, Subsampling subsampling, bool optimize) {
  const FrequencyImage& image = full_hd();
  const std::size_t width = image.width(), height = image.height();
  // Memory that is reused.
  std::vector<float> values(width * height * 3);
  std::vector<std::uint8_t> bytes(values.size());
  const PixelView view{values.data(), width, height, 3, static_cast<std::ptrdiff_t>(width * 3)};
  std::size_t size = 0;
  for (auto _ : state) {
    reconstruct(image, {}, view);
    for (std::size_t i = 0; i < values.size(); i += 3) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float shifted = values[i + c] + (c == 0 ? 0.5f : 128.5f);
        bytes[i + c] = static_cast<std::uint8_t>(std::clamp(shifted, 0.0f, 255.0f));
      }
    }
    size = pixels_to_jpeg(bytes, width, height,
                          {.quality = quality, .subsampling = subsampling, .optimize = optimize})
               .size();
  }
  state.counters["bytes"] = static_cast<double>(size);
}

#define FREQSYNTH_JPEG_CASE(name, subsampling)                        \
  BENCHMARK_CAPTURE(quantization, name, subsampling)                  \
      ->Name("jpeg/1920x1080/" #name "/quantize_only")                \
      ->Unit(benchmark::kMillisecond);                                \
  BENCHMARK_CAPTURE(coefficients, name, subsampling, false)           \
      ->Name("jpeg/1920x1080/" #name "/coefficients")                 \
      ->Unit(benchmark::kMillisecond);                                \
  BENCHMARK_CAPTURE(pixels, name, subsampling, false)                 \
      ->Name("jpeg/1920x1080/" #name "/pixels")                       \
      ->Unit(benchmark::kMillisecond);                                \
  BENCHMARK_CAPTURE(coefficients, name##_optimize, subsampling, true) \
      ->Name("jpeg/1920x1080/" #name "_optimized/coefficients")       \
      ->Unit(benchmark::kMillisecond);                                \
  BENCHMARK_CAPTURE(pixels, name##_optimize, subsampling, true)       \
      ->Name("jpeg/1920x1080/" #name "_optimized/pixels")             \
      ->Unit(benchmark::kMillisecond)
FREQSYNTH_JPEG_CASE(444, Subsampling::none);
FREQSYNTH_JPEG_CASE(420, Subsampling::both);

}  // namespace
}  // namespace freqsynth::bench

#endif
