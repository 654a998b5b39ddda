// SPDX-License-Identifier: MIT
/// \file
/// What denoisers start from: the pixels of a plain sampler, in two halves, and their variance.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rendering.h"
#include "sampler.h"

namespace baselines {

/// Values row by row, the channels of a pixel side by side.
struct Buffer {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 0;
  std::vector<float> values;

  [[nodiscard]] std::size_t pixels() const { return width * height; }
  /// `count` of the channels, from `first` on.
  [[nodiscard]] Buffer part(std::size_t first, std::size_t count) const;
};

/// Value by value.
[[nodiscard]] Buffer mean_of(const Buffer& a, const Buffer& b);

/// The mean over the square of 2 radius + 1 pixels about each pixel, of what lies in the image.
[[nodiscard]] Buffer box_mean(const Buffer& buffer, std::size_t radius);

/// Pixels that know their noise. Channels are red, green, blue, and the job's features.
struct PixelBuffers {
  /// Means of the first and of the second half of each pixel's samples; both the same where pixels
  /// have one.
  std::array<Buffer, 2> half;
  Buffer variance;  ///< of a value of `half`
};

/// Takes all samples of a job with at least one for each pixel: Owen-scrambled Sobol points in each
/// pixel, as sobol_box() does. Samples that are not enough for one more in each are spread evenly.
///
/// The variance is that of the samples, the mean of 3 x 3 pixels of it, scaled to agree with the
/// difference of the halves over 21 x 21 pixels, for evenly spread samples have less noise together
/// than random ones (Rousselle, Manzi and Zwicker, Robust Denoising using Feature and Color
/// Information, 2013). Where a pixel has one sample it is the variance among 3 x 3 pixels.
[[nodiscard]] PixelBuffers sample_pixels(Sampler& sampler, const Job& job);

/// The three colours of a buffer as a picture.
[[nodiscard]] Rendering picture_of(const Buffer& buffer, const Sampler& sampler);

}  // namespace baselines
