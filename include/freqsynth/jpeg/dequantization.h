// SPDX-License-Identifier: MIT
/// \file
/// The way back from quantised coefficients to a frequency image (paper, section 2): steps undone,
/// chroma of a lower resolution enlarged.
#pragma once

#include "freqsynth/basis/config.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/jpeg/quantized_image.h"

namespace freqsynth {

/// All components as one image of finished pixels with the signal that quantize() takes. Components
/// of a lower resolution are replicated in the frequency domain. What a file holds beyond the image
/// is dropped: a block narrower than 8 pixels has as many frequencies as pixels, so that only whole
/// blocks are sure to give the same integers when they are quantised again.
/// \throws std::invalid_argument when QuantizedImage::validate() does, or a component's sampling
///         factors do not divide the largest ones.
[[nodiscard]] FREQSYNTH_API FrequencyImage dequantize(const QuantizedImage& image);

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/dequantization.inl"
#endif
