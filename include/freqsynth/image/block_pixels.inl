// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/image/block_pixels.h"

namespace freqsynth::detail {

FREQSYNTH_INLINE std::array<float, max_terms> amplitude_factors(CoefficientMeaning meaning) {
  std::array<float, max_terms> factors;
  for (std::size_t i = 0; i < max_terms; ++i) {
    double factor = amplitude_of_coefficient(i);
    // Undo the average over a pixel, which the weights of the output apply anew.
    if (meaning == CoefficientMeaning::pixel_average) factor /= pixel_mean_of_term(i);
    factors[i] = static_cast<float>(factor);
  }
  return factors;
}

FREQSYNTH_INLINE OutputAxes::OutputAxes(std::size_t width, std::size_t height, PixelFilter filter,
                                        const PixelFilterShape& shape, const PixelView& output)
    : view(output),
      columns(make_axis(width, output.width, filter, shape, WeightOrder::by_frequency)),
      rows(make_axis(height, output.height, filter, shape, WeightOrder::by_pixel)) {}

FREQSYNTH_INLINE bool OutputAxes::separate() const {
  const auto continues = [](const AxisBlock& block) { return block.begun > 0; };
  return std::none_of(columns.begin(), columns.end(), continues) &&
         std::none_of(rows.begin(), rows.end(), continues);
}

FREQSYNTH_INLINE void BlockPixels::go_to(const AxisBlock& column, const AxisBlock& row,
                                         std::size_t first, std::size_t last) {
  column_ = &column;
  row_ = &row;
  first_ = first;
  count_ = last - first;
  stride_ = padded(column.count);
  pixels_.resize(count_ * stride_);
}

FREQSYNTH_INLINE void BlockPixels::compute(std::span<const float, max_terms> coefficients,
                                           const std::array<float, max_terms>& factors) {
  std::array<float, max_terms> amplitudes;
  for (std::size_t i = 0; i < max_terms; ++i) amplitudes[i] = coefficients[i] * factors[i];
  AlignedBlock rows;
  to_row_major(amplitudes, rows);
  compute(rows);
}

FREQSYNTH_INLINE void BlockPixels::compute(const AlignedBlock& amplitudes) {
  evaluate_separable(amplitudes.data(), column_->weights.data(), stride_, stride_,
                     row_->weights.data() + first_ * block_size, count_, pixels_.data(), stride_);
}

FREQSYNTH_INLINE void BlockPixels::clamp_negative() {
  float* const pixels = pixels_.data();
  for (std::size_t i = 0; i < count_ * stride_; ++i) pixels[i] = std::max(pixels[i], 0.0f);
}

FREQSYNTH_INLINE void BlockPixels::write(const PixelView& out, std::size_t channel) const {
  float* const corner = out.data + static_cast<std::ptrdiff_t>(channel) * out.channel_stride +
                        static_cast<std::ptrdiff_t>(row_->first + first_) * out.row_stride +
                        static_cast<std::ptrdiff_t>(column_->first) * out.pixel_stride;
  const std::size_t count = column_->count;
  const std::ptrdiff_t step = out.pixel_stride;
  for (std::size_t r = 0; r < count_; ++r) {
    float* const line = corner + static_cast<std::ptrdiff_t>(r) * out.row_stride;
    const float* const source = pixels_.data() + r * stride_;
    // Pixels that an earlier block has begun: first rows, or the first ones of a row.
    const bool begun_row = first_ + r < row_->begun;
    const std::size_t begun = begun_row ? count : std::min(column_->begun, count);
    if (begun == 0 && count == block_size) {
      float* to = line;
      for (std::size_t c = 0; c < block_size; ++c, to += step) *to = source[c];
      continue;
    }
    for (std::size_t c = 0; c < begun; ++c) {
      line[static_cast<std::ptrdiff_t>(c) * step] += source[c];
    }
    for (std::size_t c = begun; c < count; ++c) {
      line[static_cast<std::ptrdiff_t>(c) * step] = source[c];
    }
  }
}

}  // namespace freqsynth::detail
