// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/image/reconstructor.h"

namespace freqsynth {
namespace detail {

/// The factors that turn coefficients F into filtered amplitudes of a point function.
inline ButterworthTable amplitude_factors(const FrequencyImage& image,
                                          ButterworthSettings settings) {
  const bool averages = image.meaning() == CoefficientMeaning::pixel_average;
  std::array<float, max_terms> scale;
  for (std::size_t i = 0; i < max_terms; ++i) {
    double factor = amplitude_of_coefficient(i);
    // Undo the average over a pixel, which the weights of the output apply anew.
    if (averages) factor /= pixel_mean_of_term(i);
    scale[i] = static_cast<float>(factor);
  }
  if (averages) settings.enabled = false;
  return {settings, scale};
}

/// The pixels that one block contributes to, in memory of their own.
class BlockPixels {
 public:
  void go_to(const AxisBlock& column, const AxisBlock& row) {
    column_ = &column;
    row_ = &row;
    stride_ = padded(column.count);
    weights_.assign(column.weights.begin(), column.weights.end());
    pixels_.resize(row.count * stride_);
  }

  void compute(std::span<const float, max_terms> coefficients,
               const std::array<float, max_terms>& factors) {
    for (std::size_t i = 0; i < max_terms; ++i) {
      amplitudes_[zigzag_to_row_major[i]] = coefficients[i] * factors[i];
    }
    evaluate_separable(amplitudes_.data(), weights_.data(), stride_, stride_, row_->weights.data(),
                       row_->count, pixels_.data(), stride_);
  }

  /// No block takes light away where there is none that is negative.
  void clamp_negative() {
    float* const pixels = pixels_.data();
    for (std::size_t i = 0; i < row_->count * stride_; ++i) pixels[i] = std::max(pixels[i], 0.0f);
  }

  /// Writes the pixels, or adds them to those that an earlier block has begun.
  void write(const PixelView& out, std::size_t channel) const {
    float* const corner = out.data + static_cast<std::ptrdiff_t>(channel) * out.channel_stride +
                          static_cast<std::ptrdiff_t>(row_->first) * out.row_stride +
                          static_cast<std::ptrdiff_t>(column_->first) * out.pixel_stride;
    const std::size_t count = column_->count;
    const std::ptrdiff_t step = out.pixel_stride;
    for (std::size_t r = 0; r < row_->count; ++r) {
      float* const line = corner + static_cast<std::ptrdiff_t>(r) * out.row_stride;
      const float* const source = pixels_.data() + r * stride_;
      // Pixels that an earlier block has begun: the first row, or the first one of a row.
      const bool begun_row = r == 0 && row_->continues;
      const std::size_t begun = begun_row ? count : column_->continues && count > 0 ? 1 : 0;
      for (std::size_t c = 0; c < begun; ++c)
        line[static_cast<std::ptrdiff_t>(c) * step] += source[c];
      for (std::size_t c = begun; c < count; ++c) {
        line[static_cast<std::ptrdiff_t>(c) * step] = source[c];
      }
    }
  }

 private:
  const AxisBlock* column_ = nullptr;
  const AxisBlock* row_ = nullptr;
  std::size_t stride_ = 0;
  AlignedBlock amplitudes_;
  AlignedVector<float> weights_, pixels_;
};

inline void clamp_negative_values(const PixelView& out, std::size_t channels) {
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < out.width; ++x) {
      for (std::size_t channel = 0; channel < channels; ++channel) {
        float& value = out.data[static_cast<std::ptrdiff_t>(y) * out.row_stride +
                                static_cast<std::ptrdiff_t>(x) * out.pixel_stride +
                                static_cast<std::ptrdiff_t>(channel) * out.channel_stride];
        value = std::max(value, 0.0f);
      }
    }
  }
}

}  // namespace detail

FREQSYNTH_INLINE void reconstruct(const FrequencyImage& image,
                                  const ReconstructionSettings& settings, const PixelView& out) {
  settings.butterworth.validate();
  if (image.blocks_x() == 0 || image.blocks_y() == 0 || out.width == 0 || out.height == 0) return;
  const PixelView view = out.resolved(image.channels());
  // The weights of an average are right for coefficients that are averages too, once undone.
  using detail::WeightOrder;
  const auto columns = detail::make_axis(image.width(), view.width, settings.pixel_filter,
                                         WeightOrder::by_frequency);
  const auto rows =
      detail::make_axis(image.height(), view.height, settings.pixel_filter, WeightOrder::by_pixel);
  detail::ButterworthTable factors = detail::amplitude_factors(image, settings.butterworth);
  detail::BlockPixels pixels;
  for (std::size_t by = 0; by < rows.size(); ++by) {
    for (std::size_t bx = 0; bx < columns.size(); ++bx) {
      const auto& factor = factors.of(image.samples(bx, by));
      pixels.go_to(columns[bx], rows[by]);
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        pixels.compute(image.coefficients(bx, by, channel), factor);
        if (image.non_negative(channel)) pixels.clamp_negative();
        pixels.write(view, channel);
      }
    }
  }
  if (settings.clamp_negative) detail::clamp_negative_values(view, image.channels());
}

FREQSYNTH_INLINE std::size_t scaled_size(std::size_t size, double scale) {
  detail::require(detail::is_finite(scale) && scale > 0, "scale", scale, "a finite number > 0");
  const double scaled = std::ceil(static_cast<double>(size) * scale);
  if (scaled > 4294967295.0) {
    detail::refuse("scale " + detail::to_text(scale) + " of " + std::to_string(size) +
                   " pixels is too large");
  }
  return static_cast<std::size_t>(scaled);
}

FREQSYNTH_INLINE std::vector<float> reconstruct(const FrequencyImage& image,
                                                const ReconstructionSettings& settings,
                                                double scale) {
  const std::size_t width = scaled_size(image.width(), scale);
  const std::size_t height = scaled_size(image.height(), scale);
  std::vector<float> pixels(width * height * image.channels());
  reconstruct(image, settings, {pixels.data(), width, height});
  return pixels;
}

FREQSYNTH_INLINE void evaluate(const FrequencyImage& image, const ButterworthSettings& butterworth,
                               double x, double y, std::span<float> values) {
  butterworth.validate();
  const auto width = static_cast<double>(image.width());
  const auto height = static_cast<double>(image.height());
  const bool number = detail::is_finite(x) && detail::is_finite(y);
  if (image.blocks_x() == 0 || !number || x < 0 || x > width || y < 0 || y > height) {
    detail::refuse("evaluate: (" + detail::to_text(x) + ", " + detail::to_text(y) +
                   ") is not in the image");
  }
  if (values.size() != image.channels()) {
    detail::refuse("evaluate: room for " + std::to_string(values.size()) + " of " +
                   std::to_string(image.channels()) + " channels");
  }
  const auto block_of = [](double at, std::size_t blocks) {
    return std::min(static_cast<std::size_t>(at / block_size), blocks - 1);
  };
  const std::size_t bx = block_of(x, image.blocks_x());
  const std::size_t by = block_of(y, image.blocks_y());
  detail::ButterworthTable factors = detail::amplitude_factors(image, butterworth);
  std::array<double, max_terms> terms;
  const auto place = [](double at, std::size_t block, std::size_t length) {
    return (at - static_cast<double>(block * block_size)) / static_cast<double>(length);
  };
  evaluate_terms(place(x, bx, image.block_width(bx)), place(y, by, image.block_height(by)), terms);
  const auto& factor = factors.of(image.samples(bx, by));
  for (std::size_t channel = 0; channel < image.channels(); ++channel) {
    const auto coefficients = image.coefficients(bx, by, channel);
    double sum = 0;
    for (std::size_t i = 0; i < max_terms; ++i) {
      sum += terms[i] * double{coefficients[i] * factor[i]};
    }
    values[channel] = static_cast<float>(image.non_negative(channel) ? std::max(sum, 0.0) : sum);
  }
}

}  // namespace freqsynth
