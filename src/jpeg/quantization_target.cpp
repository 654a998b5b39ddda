#include "freqsynth/jpeg/quantization_target.h"

#include <limits>

#include "freqsynth/basis/dct.h"
#include "freqsynth/jpeg/quantization.h"

namespace freqsynth {

QuantizationTarget quantization_target(const QuantizationSettings& settings, std::size_t channels,
                                       double tolerance) {
  QuantizationTarget target;
  target.tolerance = tolerance;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const QuantizationTable& table = channel == 0 ? settings.luminance : settings.chrominance;
    const bool half = channel > 0 && settings.subsampling == Subsampling::both;
    auto& steps = target.steps.emplace_back();
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      if (!half) {
        steps[i] = table[i];
      } else if (f.u < block_size / 2 && f.v < block_size / 2) {
        // The four blocks' terms (u, v) make (2u, 2v) and those beside it, with a quarter of the
        // variance.
        steps[i] = 2.0f * static_cast<float>(table[term_of_frequency(2 * f.u, 2 * f.v)]);
      } else {
        steps[i] = std::numeric_limits<float>::infinity();
      }
    }
  }
  target.validate(channels);
  return target;
}

}  // namespace freqsynth
