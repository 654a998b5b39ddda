// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/block_pixels.h"
#include "freqsynth/image/mean_filter.h"
#include "freqsynth/image/reconstructor.h"

namespace freqsynth {
namespace detail {

/// Finished pixels are not filtered again.
inline ButterworthSettings filter_of(const FrequencyImage& image, ButterworthSettings settings) {
  if (image.meaning() == CoefficientMeaning::pixel_average) settings.enabled = false;
  return settings;
}

inline std::vector<std::uint32_t> sample_counts(const FrequencyImage& image) {
  std::vector<std::uint32_t> counts;
  counts.reserve(image.blocks_x() * image.blocks_y());
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) counts.push_back(image.samples(x, y));
  }
  return counts;
}

/// Some rows of pixels of an output.
struct PixelRows {
  std::size_t first, last;  ///< the last one is beyond them
};

/// Calls make(rows) for parts of all rows, which belong to one thread each, so that what several
/// blocks add to a pixel comes in one order.
template <class Make>
void share_rows(const ExecutorRef& executor, std::size_t height, std::size_t blocks_y,
                const Make& make) {
  const std::size_t parts = std::min(height, (blocks_y + 7) / 8);
  share_pieces(executor, parts, [&](std::size_t part) {
    make(PixelRows{part * height / parts, (part + 1) * height / parts});
  });
}

/// In all channels, or in those that the image says are not negative.
inline void clamp_negative_values(const PixelView& out, const FrequencyImage& image, bool all,
                                  const PixelRows& rows) {
  for (std::size_t y = rows.first; y < rows.last; ++y) {
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

/// Rows of pixels from the coefficients of all blocks that contribute to them.
inline void reconstruct_rows(const FrequencyImage& image, const ButterworthFilters& factors,
                             const OutputAxes& axes, bool wide, const PixelRows& rows) {
  BlockPixels pixels;
  for (std::size_t by = 0; by < axes.rows.size(); ++by) {
    const AxisBlock& row = axes.rows[by];
    const std::size_t first = std::max(rows.first, row.first);
    const std::size_t last = std::min(rows.last, row.first + row.count);
    if (first >= last) continue;
    for (std::size_t bx = 0; bx < axes.columns.size(); ++bx) {
      const auto& factor = factors.of(image.samples(bx, by));
      pixels.go_to(axes.columns[bx], row, first - row.first, last - row.first);
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        pixels.compute(image.coefficients(bx, by, channel), factor);
        if (!wide && image.non_negative(channel)) pixels.clamp_negative();
        pixels.write(axes.view, channel);
      }
    }
  }
}

/// Pixels from the coefficients of the blocks that they lie in.
inline void reconstruct_blocks(const FrequencyImage& image, const ReconstructionSettings& settings,
                               bool wide, const PixelView& out, const ExecutorRef& executor) {
  // The weights of an average are right for coefficients that are averages too, once undone.
  const OutputAxes axes(image.width(), image.height(), settings.pixel_filter, settings.filter_shape,
                        out);
  const ButterworthFilters factors(filter_of(image, settings.butterworth), sample_counts(image),
                                   executor, amplitude_factors(image.meaning()));
  share_rows(executor, out.height, image.blocks_y(),
             [&](const PixelRows& rows) { reconstruct_rows(image, factors, axes, wide, rows); });
}

/// Finished pixels with a wide filter: the pixels, whose averages they are, of one channel after
/// the other. Takes memory for the image at its own size.
inline void filter_finished_pixels(const FrequencyImage& image,
                                   const ReconstructionSettings& settings, const PixelView& out,
                                   const ExecutorRef& executor) {
  const std::size_t width = image.width(), height = image.height(), channels = image.channels();
  std::vector<float> means(width * height * channels);
  reconstruct_on(image, {.butterworth = settings.butterworth},
                 {means.data(), width, height, 1, static_cast<std::ptrdiff_t>(width),
                  static_cast<std::ptrdiff_t>(width * height)},
                 executor);
  const FilterKernel kernel(settings.pixel_filter, settings.filter_shape);
  const MeanAxis columns = make_mean_axis(width, out.width, kernel);
  const MeanAxis rows = make_mean_axis(height, out.height, kernel);
  share_pieces(executor, channels, [&](std::size_t channel) {
    PixelView one = out;
    one.data += static_cast<std::ptrdiff_t>(channel) * out.channel_stride;
    filter_means(means.data() + channel * width * height, width, columns, rows,
                 !kernel.has_negative(), one);
  });
}

FREQSYNTH_INLINE void reconstruct_on(const FrequencyImage& image,
                                     const ReconstructionSettings& settings, const PixelView& out,
                                     const ExecutorRef& executor) {
  settings.butterworth.validate();
  settings.filter_shape.validate(settings.pixel_filter);
  if (image.blocks_x() == 0 || image.blocks_y() == 0 || out.width == 0 || out.height == 0) return;
  const PixelView view = out.resolved(image.channels());
  // Where blocks share pixels, and weights may be negative, it is the sums that must not be.
  const bool wide = is_wide(settings.pixel_filter, settings.filter_shape);
  if (wide && image.meaning() == CoefficientMeaning::pixel_average) {
    filter_finished_pixels(image, settings, view, executor);
  } else {
    reconstruct_blocks(image, settings, wide, view, executor);
  }
  if (settings.clamp_negative || wide) {
    share_rows(executor, view.height, image.blocks_y(), [&](const PixelRows& rows) {
      clamp_negative_values(view, image, settings.clamp_negative, rows);
    });
  }
}

}  // namespace detail

FREQSYNTH_INLINE void reconstruct(const FrequencyImage& image,
                                  const ReconstructionSettings& settings, const PixelView& out) {
  detail::reconstruct_on(image, settings, out, {});
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
  auto factor = butterworth_factors(detail::filter_of(image, butterworth), image.samples(bx, by));
  const auto scale = detail::amplitude_factors(image.meaning());
  for (std::size_t i = 0; i < max_terms; ++i) factor[i] *= scale[i];
  std::array<double, max_terms> terms;
  const auto place = [](double at, std::size_t block, std::size_t length) {
    return (at - static_cast<double>(block * block_size)) / static_cast<double>(length);
  };
  evaluate_terms(place(x, bx, image.block_width(bx)), place(y, by, image.block_height(by)), terms);
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
