// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "freqsynth/basis/dct.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/axis_weights.h"

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

FREQSYNTH_INLINE std::vector<AxisBlock> make_axis(std::size_t size, std::size_t out,
                                                  PixelFilter filter, WeightOrder order) {
  const bool by_frequency = order == WeightOrder::by_frequency;
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
    axis.count = last - first;
    axis.continues = filter == PixelFilter::box && first * size < begin;
    const std::size_t stride = padded(axis.count);
    axis.weights.assign(by_frequency ? block_size * stride : axis.count * block_size, 0);
    for (std::size_t i = 0; i < axis.count; ++i) {
      for (std::size_t u = 0; u < block_size; ++u) {
        const double weight =
            weight_in_pixel({(first + i) * size, (first + i + 1) * size}, {begin, end}, u, filter);
        axis.weights[by_frequency ? u * stride + i : i * block_size + u] =
            static_cast<float>(weight);
      }
    }
  }
  return blocks;
}

}  // namespace freqsynth::detail
