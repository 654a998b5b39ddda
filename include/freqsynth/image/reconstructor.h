// SPDX-License-Identifier: MIT
/// \file
/// Frequency image to pixels (paper, section 4.5): filtered by multiplying coefficients, at any
/// resolution, into the caller's memory.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_filter.h"
#include "freqsynth/image/pixel_view.h"

namespace freqsynth {

/// How pixels are made of coefficients.
struct ReconstructionSettings {
  /// Applies to CoefficientMeaning::point_function; finished pixels are not filtered again.
  ButterworthSettings butterworth = {};
  PixelFilter pixel_filter = PixelFilter::box;  ///< what a pixel's value is
  /// Replace values below zero, the ringing beside bright edges, by zero in all channels. In those
  /// that the image says are not negative they are in any case.
  bool clamp_negative = false;
  PixelFilterShape filter_shape = {};  ///< the numbers of `pixel_filter`
};

/// Writes the image into `out`: all its channels, at any width and height. Pixel (i, j) covers the
/// same share of the image as of the output, so that a size different from the image's own scales
/// it.
/// \throws std::invalid_argument when a filter setting is out of range, memory is missing, or the
///         strides of `out` put two values in one place.
FREQSYNTH_API void reconstruct(const FrequencyImage& image, const ReconstructionSettings& settings,
                               const PixelView& out);

namespace detail {
FREQSYNTH_API void reconstruct_on(const FrequencyImage& image,
                                  const ReconstructionSettings& settings, const PixelView& out,
                                  const ExecutorRef& executor);
}  // namespace detail

/// The same on an executor's threads; the result does not depend on it.
/// \throws what the executor throws, too.
template <class E>
requires Executor<std::remove_reference_t<E>>
void reconstruct(const FrequencyImage& image, const ReconstructionSettings& settings,
                 const PixelView& out, E&& executor) {
  detail::reconstruct_on(image, settings, out, detail::ExecutorRef(executor));
}

/// The same at the image's own size times `scale` (rounded up), row by row, channels interleaved.
/// \throws std::invalid_argument when scale is not a finite number > 0 or the size overflows.
[[nodiscard]] FREQSYNTH_API std::vector<float> reconstruct(
    const FrequencyImage& image, const ReconstructionSettings& settings = {}, double scale = 1);

/// ceil(size * scale), the size in pixels of a scaled image.
/// \throws std::invalid_argument when scale is not a finite number > 0 or the size overflows.
[[nodiscard]] FREQSYNTH_API std::size_t scaled_size(std::size_t size, double scale);

/// Writes the value of each channel of the filtered function at (x, y), in pixels within the image.
/// \throws std::invalid_argument when the point lies outside, the image is empty, or `values` does
///         not hold image.channels() numbers.
FREQSYNTH_API void evaluate(const FrequencyImage& image, const ButterworthSettings& butterworth,
                            double x, double y, std::span<float> values);

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/reconstructor.inl"
#endif
