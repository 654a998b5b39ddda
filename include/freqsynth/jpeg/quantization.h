// SPDX-License-Identifier: MIT
/// \file
/// Frequency image to quantised JPEG coefficients (paper, section 2, eq. 3), chroma at half the
/// resolution included.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/jpeg/quantization_tables.h"
#include "freqsynth/jpeg/quantization_target.h"
#include "freqsynth/jpeg/quantized_image.h"

namespace freqsynth {

/// Resolution of the chroma components.
enum class Subsampling : std::uint8_t {
  none,  ///< 4:4:4
  both   ///< 4:2:0, half the resolution in both directions
};

/// Tables, and what comes before them.
struct QuantizationSettings {
  QuantizationTable luminance = luminance_table();      ///< for the first channel
  QuantizationTable chrominance = chrominance_table();  ///< for all others
  Subsampling subsampling = Subsampling::none;          ///< of all channels but the first
  /// Applies to CoefficientMeaning::point_function; finished pixels are not filtered again.
  ButterworthSettings butterworth = {};
};

/// Quantises an image whose signal is that of JPEG: one channel Y, or three channels Y, Cb and Cr,
/// with Y in 0..255 and Cb and Cr around 0 (see display_encoding.h). The pixels that a decoder
/// makes of the result are those of reconstruct() with the box filter, up to the quantiser's
/// rounding. JPEG's blocks all have 8 x 8 pixels: those beyond the image are its mirror image.
///
/// AC values are clamped to +-1023 and DC values to -1024..1023, so that no difference exceeds
/// 2047.
/// \throws std::invalid_argument when the image has no pixels, its channels are neither 1 nor 3, a
///         table holds a zero, or the Butterworth settings are out of range.
[[nodiscard]] FREQSYNTH_API QuantizedImage quantize(const FrequencyImage& image,
                                                    const QuantizationSettings& settings = {});

/// The target of a synthesis that ends in quantize() with these settings. Chroma at half the
/// resolution counts as steps twice as large, and none where the resolution is lost.
/// \throws std::invalid_argument like quantize(), and when the tolerance is not a finite number > 0.
[[nodiscard]] FREQSYNTH_API QuantizationTarget quantization_target(
    const QuantizationSettings& settings, std::size_t channels, double tolerance = 0.25);

/// Coefficients of the 8 x 8 block that holds the means of 2 x 2 pixels of four blocks: a fixed
/// linear map.
/// \param blocks  the blocks top left, top right, bottom left, bottom right; zig-zag
[[nodiscard]] FREQSYNTH_API std::array<float, max_terms> halve_blocks(
    const std::array<std::array<float, max_terms>, 4>& blocks);

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/quantization.inl"
#endif
