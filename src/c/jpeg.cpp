// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/jpeg.h"

#include <cstdint>
#include <vector>

#include "c/bridge.h"
#include "freqsynth/c/jpeg.h"
#include "freqsynth/jpeg/jpeg_file.h"

namespace freqsynth::detail {
namespace {

QuantizedImage quantized(const freqsynth_image* image, const freqsynth_jpeg_settings& c) {
  const FrequencyImage& from = object(image, "image").image;
  QuantizationSettings settings;
  settings.luminance = scale_table(settings.luminance, c.quality);
  settings.chrominance = scale_table(settings.chrominance, c.quality);
  if (c.half_chroma != 0) settings.subsampling = Subsampling::both;
  if (c.encoded != 0) return quantize(from, settings);
  return quantize(encode_pixels(from, {c.exposure}), settings);
}

JpegOptions options_of(const freqsynth_jpeg_settings& c) {
  return {.progressive = c.progressive != 0, .optimize = c.optimize != 0};
}

}  // namespace
}  // namespace freqsynth::detail

using namespace freqsynth::detail;

void freqsynth_jpeg_settings_init(freqsynth_jpeg_settings* settings, size_t size) {
  freqsynth_jpeg_settings usual = {};
  usual.quality = 75;
  usual.optimize = 1;
  usual.exposure = 1;
  write_defaults(usual, settings, size);
}

freqsynth_status freqsynth_encode_jpeg(const freqsynth_image* image,
                                       const freqsynth_jpeg_settings* settings,
                                       freqsynth_write_callback write, void* user) {
  return guarded([&] {
    const auto all = read_settings(settings, freqsynth_jpeg_settings_init, "jpeg settings");
    if (write == nullptr) refuse("write is NULL");
    const std::vector<std::uint8_t> bytes =
        freqsynth::encode_jpeg(quantized(image, all), options_of(all));
    const int code = write(user, bytes.data(), bytes.size());
    if (code != 0) throw CallbackFailure("write callback", code);
  });
}

freqsynth_status freqsynth_write_jpeg(const freqsynth_image* image,
                                      const freqsynth_jpeg_settings* settings, const char* file) {
  return guarded([&] {
    const auto all = read_settings(settings, freqsynth_jpeg_settings_init, "jpeg settings");
    freqsynth::write_jpeg(file_name(file), quantized(image, all), options_of(all));
  });
}
