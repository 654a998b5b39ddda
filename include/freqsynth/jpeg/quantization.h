/// \file
/// Frequency image to quantised JPEG coefficients (paper, section 2, eq. 3): tables, chroma
/// subsampling, and the quantised image as a plain value that any encoder can take.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/jpeg/quantization_target.h"

namespace freqsynth {

/// Quantiser steps Q(u, v) >= 1 in zig-zag order.
using QuantizationTable = std::array<std::uint16_t, max_terms>;

/// The table of figure 5, the example for luminance in the JPEG standard (ITU-T T.81, table K.1).
[[nodiscard]] const QuantizationTable& luminance_table();

/// The standard's example for chrominance (table K.2).
[[nodiscard]] const QuantizationTable& chrominance_table();

/// `table` made finer or coarser like libjpeg does: 50 leaves it as it is, 100 makes all steps 1.
/// Steps stay in 1..255, the range of baseline JPEG.
/// \throws std::invalid_argument when quality is not in 1..100 or the table holds a zero.
[[nodiscard]] QuantizationTable scale_table(const QuantizationTable& table, int quality);

/// Resolution of the chroma components.
enum class Subsampling : std::uint8_t {
  none,  ///< 4:4:4
  both   ///< 4:2:0, half the resolution in both directions
};

struct QuantizationSettings {
  QuantizationTable luminance = luminance_table();      ///< for the first channel
  QuantizationTable chrominance = chrominance_table();  ///< for all others
  Subsampling subsampling = Subsampling::none;
  /// Applies to CoefficientMeaning::point_function; finished pixels are not filtered again.
  ButterworthSettings butterworth = {};
};

/// One colour component of a quantised image.
struct QuantizedComponent {
  std::size_t blocks_x = 0, blocks_y = 0;
  /// Sampling factors of JPEG: blocks of this component in a group of blocks.
  int horizontal = 1, vertical = 1;
  std::size_t table = 0;             ///< index of its table
  std::vector<std::int16_t> values;  ///< [block][term], terms in zig-zag order
};

/// An image as quantised coefficients, level-shifted as JPEG stores them.
struct QuantizedImage {
  std::size_t width = 0, height = 0;  ///< pixels
  std::vector<QuantizationTable> tables;
  std::vector<QuantizedComponent> components;
  /// Coefficients that baseline JPEG cannot code and that were clamped, or were not numbers.
  std::uint64_t clamped = 0;

  /// \throws std::invalid_argument naming the fault when there are no pixels or no components, a
  ///         table holds a zero, or a component's sampling factors (1..4), table, number of blocks
  ///         or number of values do not fit the rest.
  void validate() const;
};

/// Quantises an image whose signal is that of JPEG: one channel Y, or three channels Y, Cb and Cr,
/// with Y in 0..255 and Cb and Cr around 0 (see display_encoding.h). The pixels that a decoder
/// makes of the result are those of reconstruct() with the box filter, up to the quantiser's
/// rounding.
///
/// AC values are clamped to +-1023 and DC values to -1024..1023, so that no difference exceeds
/// 2047.
/// \throws std::invalid_argument when the image has no pixels, its channels are neither 1 nor 3, a
///         table holds a zero, or the Butterworth settings are out of range.
[[nodiscard]] QuantizedImage quantize(const FrequencyImage& image,
                                      const QuantizationSettings& settings = {});

/// The target of a synthesis that ends in quantize() with these settings. Chroma at half the
/// resolution counts as steps twice as large, and none where the resolution is lost.
/// \throws std::invalid_argument like quantize().
[[nodiscard]] QuantizationTarget quantization_target(const QuantizationSettings& settings,
                                                     std::size_t channels, double tolerance = 0.25);

/// The way back: all components as one image of finished pixels with the signal described above.
/// Components of a lower resolution are replicated in the frequency domain.
/// \throws std::invalid_argument when QuantizedImage::validate() does, or a component's sampling
///         factors do not divide the largest ones.
[[nodiscard]] FrequencyImage dequantize(const QuantizedImage& image);

/// Coefficients of the 8 x 8 block that holds the means of 2 x 2 pixels of four blocks: a fixed
/// linear map.
/// \param blocks  the blocks top left, top right, bottom left, bottom right; zig-zag
[[nodiscard]] std::array<float, max_terms> halve_blocks(
    const std::array<std::array<float, max_terms>, 4>& blocks);

}  // namespace freqsynth
