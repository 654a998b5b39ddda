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
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include "fixtures.h"
#include "freqsynth/display_encoding.h"
#include "freqsynth/jpeg.h"
#include "freqsynth/quantization.h"
#include "freqsynth/reconstructor.h"
#include "freqsynth/synthesizer.h"

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

std::size_t compress(const std::vector<std::uint8_t>& pixels, std::size_t width, std::size_t height,
                     Subsampling subsampling, bool optimize) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = 3;
  info.in_color_space = JCS_YCbCr;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor =
      subsampling == Subsampling::both ? 2 : 1;
  info.optimize_coding = optimize ? TRUE : FALSE;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPLE*>(pixels.data() + info.next_scanline * width * 3);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::free(bytes);
  return size;
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
    size = compress(bytes, width, height, subsampling, optimize);
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
