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
#include "freqsynth/image/axis_weights.h"
#include "freqsynth/image/mean_filter.h"
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
      // Pixels that an earlier block has begun: first rows, or the first ones of a row.
      const std::size_t begun = r < row_->begun ? count : std::min(column_->begun, count);
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

/// In all channels, or in those that the image says are not negative.
inline void clamp_negative_values(const PixelView& out, const FrequencyImage& image, bool all) {
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < out.width; ++x) {
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        if (!all && !image.non_negative(channel)) continue;
        float& value = out.data[static_cast<std::ptrdiff_t>(y) * out.row_stride +
                                static_cast<std::ptrdiff_t>(x) * out.pixel_stride +
                                static_cast<std::ptrdiff_t>(channel) * out.channel_stride];
        value = std::max(value, 0.0f);
      }
    }
  }
}

/// Pixels from the coefficients of the blocks that they lie in.
inline void reconstruct_blocks(const FrequencyImage& image, const ReconstructionSettings& settings,
                               bool wide, const PixelView& out) {
  // The weights of an average are right for coefficients that are averages too, once undone.
  const auto axis_of = [&](std::size_t size, std::size_t pixels, WeightOrder order) {
    return make_axis(size, pixels, settings.pixel_filter, settings.filter_shape, order);
  };
  const auto columns = axis_of(image.width(), out.width, WeightOrder::by_frequency);
  const auto rows = axis_of(image.height(), out.height, WeightOrder::by_pixel);
  ButterworthTable factors = amplitude_factors(image, settings.butterworth);
  BlockPixels pixels;
  for (std::size_t by = 0; by < rows.size(); ++by) {
    for (std::size_t bx = 0; bx < columns.size(); ++bx) {
      const auto& factor = factors.of(image.samples(bx, by));
      pixels.go_to(columns[bx], rows[by]);
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        pixels.compute(image.coefficients(bx, by, channel), factor);
        if (!wide && image.non_negative(channel)) pixels.clamp_negative();
        pixels.write(out, channel);
      }
    }
  }
}

/// Finished pixels with a wide filter: the pixels, whose averages they are, of one channel after
/// the other. Takes memory for the image at its own size.
inline void filter_finished_pixels(const FrequencyImage& image,
                                   const ReconstructionSettings& settings, const PixelView& out) {
  const std::size_t width = image.width(), height = image.height(), channels = image.channels();
  std::vector<float> means(width * height * channels);
  reconstruct(image, {.butterworth = settings.butterworth},
              {means.data(), width, height, 1, static_cast<std::ptrdiff_t>(width),
               static_cast<std::ptrdiff_t>(width * height)});
  const FilterKernel kernel(settings.pixel_filter, settings.filter_shape);
  const MeanAxis columns = make_mean_axis(width, out.width, kernel);
  const MeanAxis rows = make_mean_axis(height, out.height, kernel);
  for (std::size_t channel = 0; channel < channels; ++channel) {
    PixelView one = out;
    one.data += static_cast<std::ptrdiff_t>(channel) * out.channel_stride;
    filter_means(means.data() + channel * width * height, width, columns, rows,
                 !kernel.has_negative(), one);
  }
}

}  // namespace detail

FREQSYNTH_INLINE void reconstruct(const FrequencyImage& image,
                                  const ReconstructionSettings& settings, const PixelView& out) {
  settings.butterworth.validate();
  settings.filter_shape.validate(settings.pixel_filter);
  if (image.blocks_x() == 0 || image.blocks_y() == 0 || out.width == 0 || out.height == 0) return;
  const PixelView view = out.resolved(image.channels());
  // Where blocks share pixels, and weights may be negative, it is the sums that must not be.
  const bool wide = detail::is_wide(settings.pixel_filter, settings.filter_shape);
  if (wide && image.meaning() == CoefficientMeaning::pixel_average) {
    detail::filter_finished_pixels(image, settings, view);
  } else {
    detail::reconstruct_blocks(image, settings, wide, view);
  }
  if (settings.clamp_negative || wide) {
    detail::clamp_negative_values(view, image, settings.clamp_negative);
  }
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
