// SPDX-License-Identifier: MIT
#include "freqsynth/c/quantization.h"

#include "c/bridge.h"

using namespace freqsynth::detail;

freqsynth_status freqsynth_quantization_steps(int32_t quality, int32_t half_chroma, size_t channels,
                                              float* steps) {
  return guarded([&] {
    freqsynth::QuantizationSettings settings;
    settings.luminance = freqsynth::scale_table(settings.luminance, quality);
    settings.chrominance = freqsynth::scale_table(settings.chrominance, quality);
    if (half_chroma != 0) settings.subsampling = freqsynth::Subsampling::both;
    const freqsynth::QuantizationTarget target = freqsynth::quantization_target(settings, channels);
    float* out = array(steps, freqsynth::max_terms * channels, "steps").data();
    for (const auto& of_channel : target.steps) {
      out = std::copy(of_channel.begin(), of_channel.end(), out);
    }
  });
}

freqsynth_status freqsynth_encode_display(float* values, size_t count, size_t channels,
                                          float exposure) {
  return guarded([&] {
    const freqsynth::DisplayEncoding encoding{exposure};
    check_display_channels(channels, channels);
    encoding.validate();
    array(values, count, "values");
    encoding.encode({values, count * channels}, channels);
  });
}
