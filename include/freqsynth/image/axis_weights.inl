// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "freqsynth/basis/dct.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/axis_weights.h"
#include "freqsynth/image/filter_kernel.h"

namespace freqsynth::detail {

/// From `begin` to `end`, in units of a fraction of a pixel that makes both whole numbers.
struct AxisRange {
  std::uint64_t begin, end;

  [[nodiscard]] double length() const { return static_cast<double>(end - begin); }
};

/// Weight of cos(pi u s) of a block in a pixel of the output, which may reach beyond it.
inline double weight_in_pixel(const AxisRange& pixel, const AxisRange& block, std::size_t u,
                              PixelFilter filter) {
  const double length = block.length();
  const auto place = [&](double x) { return (x - static_cast<double>(block.begin)) / length; };
  const double omega = std::numbers::pi * static_cast<double>(u);
  if (filter == PixelFilter::none) {
    return std::cos(omega * place(0.5 * static_cast<double>(pixel.begin + pixel.end)));
  }
  const double s0 = place(static_cast<double>(std::max(pixel.begin, block.begin)));
  const double s1 = place(static_cast<double>(std::min(pixel.end, block.end)));
  const double share = length / pixel.length();
  // The integral of the cosine, as the product of its value in the middle and a sinc.
  return share * (s1 - s0) * std::cos(omega * 0.5 * (s0 + s1)) *
         sinc(0.5 * static_cast<double>(u) * (s1 - s0));
}

/// Makes room for the weights of `count` pixels.
inline void set_size(AxisBlock& axis, std::size_t count, WeightOrder order) {
  axis.count = count;
  axis.weights.assign(
      order == WeightOrder::by_frequency ? block_size * padded(count) : count * block_size, 0);
}

inline float& weight_of(AxisBlock& axis, std::size_t i, std::size_t u, WeightOrder order) {
  return axis.weights[order == WeightOrder::by_frequency ? u * padded(axis.count) + i
                                                         : i * block_size + u];
}

/// An axis with a filter that may reach into several blocks.
class WideAxis {
 public:
  WideAxis(std::size_t size, std::size_t out, const FilterKernel& kernel, WeightOrder order)
      : size_(size), out_(out), kernel_(kernel), order_(order) {}

  [[nodiscard]] std::vector<AxisBlock> make() const {
    std::vector<AxisBlock> blocks((size_ + block_size - 1) / block_size);
    std::size_t end = 0;  // of the pixels that have begun
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      AxisBlock& axis = blocks[b];
      const Range block = range_of(b);
      // Pixels whose centre i + 0.5 is less than the radius from the block.
      const double radius = kernel_.radius();
      axis.first = clamped(std::ceil(block.begin - radius - 0.5));
      set_size(axis,
               std::max(clamped(std::floor(block.end + radius - 0.5) + 1), axis.first) - axis.first,
               order_);
      axis.begun = std::min(std::max(end, axis.first) - axis.first, axis.count);
      end = std::max(end, axis.first + axis.count);
      if (b > 0 && is_shifted(b, axis, blocks[b - 1])) {
        axis.weights = blocks[b - 1].weights;
      } else {
        set_weights(block, axis);
      }
    }
    return blocks;
  }

 private:
  struct Range {
    double begin, end;  // in pixels of the output
  };

  [[nodiscard]] Range range_of(std::size_t b) const {
    const auto place = [&](std::size_t at) {
      return static_cast<double>(std::uint64_t{at} * out_) / static_cast<double>(size_);
    };
    return {place(b * block_size), place(b * block_size + block_length(b, size_))};
  }

  [[nodiscard]] std::size_t clamped(double pixel) const {
    return static_cast<std::size_t>(std::clamp(pixel, 0.0, static_cast<double>(out_)));
  }

  /// Whether block b lies to its pixels as the one before does, none of which nears the border.
  [[nodiscard]] bool is_shifted(std::size_t b, const AxisBlock& axis,
                                const AxisBlock& before) const {
    const std::uint64_t step = std::uint64_t{block_size} * out_;
    const double radius = kernel_.radius();
    return step % size_ == 0 && block_length(b, size_) == block_size &&
           axis.count == before.count && axis.first == before.first + step / size_ &&
           static_cast<double>(before.first) + 0.5 >= radius &&
           static_cast<double>(axis.first + axis.count) - 0.5 + radius <= static_cast<double>(out_);
  }

  void set_weights(const Range& block, AxisBlock& axis) const {
    const double omega = std::numbers::pi / (block.end - block.begin);
    for (std::size_t i = 0; i < axis.count; ++i) {
      const double centre = static_cast<double>(axis.first + i) + 0.5;
      std::array<double, block_size> inside{}, sums{};
      kernel_.integrate(-centre, static_cast<double>(out_) - centre, 0, 0, inside);
      kernel_.integrate(block.begin - centre, block.end - centre, omega,
                        omega * (centre - block.begin), sums);
      for (std::size_t u = 0; u < block_size; ++u) {
        weight_of(axis, i, u, order_) = static_cast<float>(sums[u] / inside[0]);
      }
    }
  }

  std::size_t size_, out_;
  const FilterKernel& kernel_;
  WeightOrder order_;
};

FREQSYNTH_INLINE bool is_wide(PixelFilter filter, const PixelFilterShape& shape) {
  if (filter == PixelFilter::box) return shape.radius > 0 && shape.radius != 0.5;
  return filter != PixelFilter::none;
}

FREQSYNTH_INLINE std::vector<AxisBlock> make_axis(std::size_t size, std::size_t out,
                                                  PixelFilter filter, const PixelFilterShape& shape,
                                                  WeightOrder order) {
  if (is_wide(filter, shape)) return WideAxis(size, out, FilterKernel(filter, shape), order).make();
  std::vector<AxisBlock> blocks((size + block_size - 1) / block_size);
  // Integers: pixel i covers [i * size, (i + 1) * size] in units of 1 / out image pixels.
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    AxisBlock& axis = blocks[b];
    const std::uint64_t begin = block_size * b * out;
    const std::uint64_t end = begin + block_length(b, size) * out;
    std::uint64_t first = begin / size;
    std::uint64_t last = (end + size - 1) / size;
    if (filter == PixelFilter::none) {
      // Pixels whose centre (2 i + 1) size / 2 lies in [begin, end).
      first = (2 * begin + size - 1) / (2 * size);
      last = (2 * end + size - 1) / (2 * size);
    }
    axis.first = first;
    set_size(axis, last - first, order);
    axis.begun = filter == PixelFilter::box && first * size < begin ? 1 : 0;
    for (std::size_t i = 0; i < axis.count; ++i) {
      for (std::size_t u = 0; u < block_size; ++u) {
        weight_of(axis, i, u, order) = static_cast<float>(
            weight_in_pixel({(first + i) * size, (first + i + 1) * size}, {begin, end}, u, filter));
      }
    }
  }
  return blocks;
}

}  // namespace freqsynth::detail
