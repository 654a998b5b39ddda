/// \file
/// Frequency image to pixels (paper, section 4.5): filtered by multiplying coefficients, at any
/// resolution, into the caller's memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/frequency_image.h"

namespace freqsynth {

/// What a pixel's value is.
enum class PixelFilter : std::uint8_t {
  none,  ///< the function's value at the pixel's centre
  box    ///< its exact average over the pixel's area
};

struct ReconstructionSettings {
  /// Applies to CoefficientMeaning::point_function; finished pixels are not filtered again.
  ButterworthSettings butterworth = {};
  PixelFilter pixel_filter = PixelFilter::box;
  /// Replace values below zero, the ringing beside bright edges, by zero.
  bool clamp_negative = false;
};

/// Memory for an image, the caller's own. Strides count floats and may be negative.
struct PixelView {
  float* data = nullptr;  ///< channel 0 of the pixel in the top left corner
  std::size_t width = 0;
  std::size_t height = 0;
  std::ptrdiff_t pixel_stride = 0;    ///< from a pixel to the one on its right
  std::ptrdiff_t row_stride = 0;      ///< from a pixel to the one below
  std::ptrdiff_t channel_stride = 1;  ///< from a channel to the next
};

/// Writes the image into `out`: all its channels, at any width and height. Pixel (i, j) covers the
/// same share of the image as of the output, so that a size different from the image's own scales
/// it.
/// \throws std::invalid_argument when a filter setting is out of range, or memory is missing.
void reconstruct(const FrequencyImage& image, const ReconstructionSettings& settings,
                 const PixelView& out);

/// The same at the image's own size times `scale` (rounded up), row by row, channels interleaved.
/// \throws std::invalid_argument when scale is not a finite number > 0 or the size overflows.
[[nodiscard]] std::vector<float> reconstruct(const FrequencyImage& image,
                                             const ReconstructionSettings& settings = {},
                                             double scale = 1);

/// ceil(size * scale), the size in pixels of a scaled image.
/// \throws std::invalid_argument when scale is not a finite number > 0 or the size overflows.
[[nodiscard]] std::size_t scaled_size(std::size_t size, double scale);

/// Writes the value of each channel of the filtered function at (x, y), in pixels within the image.
/// \throws std::invalid_argument when the point lies outside, the image is empty, or `values` does
///         not hold image.channels() numbers.
void evaluate(const FrequencyImage& image, const ButterworthSettings& butterworth, double x,
              double y, std::span<float> values);

}  // namespace freqsynth
