// SPDX-License-Identifier: MIT
#include <cstdio>

#include "freqsynth/freqsynth.h"
#include "freqsynth/jpeg/jpeg.h"
#include "freqsynth/jpeg/jpeg_file.h"

// Prints the version, and only that, when the component works.
int main() {
  freqsynth::FrequencyImage image(20, 10, 3, freqsynth::CoefficientMeaning::pixel_average);
  image.coefficients(1, 1, 0)[0] = 1500;
  const freqsynth::QuantizedImage written = freqsynth::quantize(image);
  const freqsynth::QuantizedImage read = freqsynth::decode_jpeg(freqsynth::encode_jpeg(written));
  if (read.components[0].values != written.components[0].values) return 1;
  std::puts(FREQSYNTH_VERSION);
}
