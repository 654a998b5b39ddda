// SPDX-License-Identifier: MIT
#include "direct.h"

#include <cstdio>
#include <stdexcept>

#include "common/picture.h"
#include "freqsynth/jpeg/display_encoding.h"
#ifdef FREQSYNTH_HAS_JPEG
#include "freqsynth/jpeg/jpeg_file.h"
#endif

freqsynth::QuantizationSettings quantization_of(const Options& options) {
  freqsynth::QuantizationSettings settings;
  settings.luminance = freqsynth::scale_table(freqsynth::luminance_table(), options.quality);
  settings.chrominance = freqsynth::scale_table(freqsynth::chrominance_table(), options.quality);
  settings.subsampling = options.subsampling;
  settings.butterworth = options.butterworth;
  return settings;
}

#ifdef FREQSYNTH_HAS_JPEG

void check_direct(const Options& options) {
  check_jpeg_size(options.output, options.width, options.height);
  check_writable(options.output);
}

void write_direct(const Options& options, const freqsynth::FrequencyImage& image) {
  const bool pixels = options.averaging == Averaging::light;
  const freqsynth::QuantizedImage quantized = freqsynth::quantize(
      pixels ? freqsynth::encode_pixels(image, {}, {.butterworth = options.butterworth}) : image,
      quantization_of(options));
  if (quantized.clamped > 0) {
    std::fprintf(stderr, "freqsynth_render: %llu coefficients were clamped\n",
                 static_cast<unsigned long long>(quantized.clamped));
  }
  freqsynth::write_jpeg(options.output, quantized, {.progressive = options.progressive});
}

#else

void check_direct(const Options&) {
  throw std::runtime_error("--direct: this program was built without libjpeg");
}

void write_direct(const Options& options, const freqsynth::FrequencyImage&) {
  check_direct(options);
}

#endif
