// SPDX-License-Identifier: MIT
/// \file
/// All that freqsynth has to know of browsers, and they of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "attention.h"
#include "freqsynth/freqsynth.h"
#include "freqsynth/jpeg/jpeg.h"
#include "freqsynth/jpeg/quantization.h"
#include "shown_light.h"
#include "subject.h"

namespace live {

/// How the picture is shown.
struct View {
  double stops = 0;  ///< log2 of the exposure, -8..8
  int quality = 75;  ///< of JPEG, 1..100
};

/// Answers requests with light as it is shown and as it is, see shown_light.h.
struct Sampler {
  const Subject& subject;

  void operator()(std::span<const freqsynth::Request> requests, std::span<float> values) const {
    std::vector<float> rgb(3 * requests.size());
    subject.radiance(requests, rgb);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const auto sample = sample_of(std::span<const float, 3>(rgb.data() + 3 * i, 3));
      std::copy(sample.begin(), sample.end(), values.data() + i * channels);
    }
  }
};

/// Samples go where the mouse points, from the next wave on.
inline void attend(freqsynth::Synthesizer& engine, const Attention& attention) {
  const freqsynth::SynthesisSettings& settings = engine.settings();
  engine.set_importance(importance_of(attention, settings.width, settings.height));
}

/// A progressive JPEG file of an image's coefficients. No pixel is made.
inline std::vector<std::uint8_t> picture_jpeg(const freqsynth::FrequencyImage& image,
                                              const View& view) {
  freqsynth::QuantizationSettings settings;
  settings.luminance = freqsynth::scale_table(freqsynth::luminance_table(), view.quality);
  settings.chrominance = freqsynth::scale_table(freqsynth::chrominance_table(), view.quality);
  settings.subsampling = freqsynth::Subsampling::both;
  return freqsynth::encode_jpeg(freqsynth::quantize(exposed(image, view.stops), settings),
                                {.progressive = true});
}

}  // namespace live
