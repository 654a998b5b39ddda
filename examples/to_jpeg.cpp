// SPDX-License-Identifier: MIT
#include <cmath>

#include "freqsynth/freqsynth.h"
#include "freqsynth/jpeg/jpeg_file.h"

int main() {
  // Linear luminance of a function: here rings. With 3 channels it would be linear RGB.
  const auto radiance = [](double x, double y) { return 0.5 + 0.5 * std::cos(std::hypot(x, y)); };

  freqsynth::QuantizationSettings tables;
  tables.luminance = freqsynth::scale_table(freqsynth::luminance_table(), 75);

  freqsynth::SynthesisSettings settings{.width = 160, .height = 120, .channels = 1};
  settings.quantization = freqsynth::quantization_target(tables, 1);

  freqsynth::Synthesizer engine(settings);
  engine.run(freqsynth::DisplaySampler(radiance, 1), {});  // ends by itself
  freqsynth::write_jpeg("picture.jpg", freqsynth::quantize(engine.finished_image(), tables));
}
