// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/jpeg/block_scaling.h"

namespace freqsynth::detail {

FREQSYNTH_INLINE void AxisMap::apply(const AxisMap& across, const AxisMap& down,
                                     const AlignedBlock& block, AlignedBlock& out) {
  evaluate_separable(block.data(), across.from_to_.data(), block_size, block_size,
                     down.to_from_.data(), block_size, out.data(), block_size);
}

/// The cosine of eq. 1 at pixel x of a block.
inline double cosine_of_pixel(std::size_t u, std::size_t x) {
  const double angle = static_cast<double>((2 * x + 1) * u) * std::numbers::pi / 16;
  return 0.5 * kappa(u) * std::cos(angle);
}

// Pixel x of the fine block lies in pixel (8 part + x) / factor of the coarse one.
inline double shrinking_weight(std::size_t to, std::size_t from, std::size_t part,
                               std::size_t factor) {
  double sum = 0;
  for (std::size_t x = 0; x < block_size; ++x) {
    const std::size_t coarse = (part * block_size + x) / factor;
    sum += cosine_of_pixel(to, coarse) * cosine_of_pixel(from, x) / static_cast<double>(factor);
  }
  return sum;
}

inline double enlarging_weight(std::size_t to, std::size_t from, std::size_t part,
                               std::size_t factor) {
  double sum = 0;
  for (std::size_t x = 0; x < block_size; ++x) {
    const std::size_t coarse = (part * block_size + x) / factor;
    sum += cosine_of_pixel(to, x) * cosine_of_pixel(from, coarse);
  }
  return sum;
}

inline double extending_weight(std::size_t to, std::size_t from, std::size_t length) {
  const auto pixels = static_cast<double>(length);
  const auto frequency = static_cast<double>(from);
  // From the mean over a cell, an eighth of the block, to that over a pixel.
  const double scale = 0.5 * kappa(from) * sinc(frequency / (2 * pixels)) / sinc(frequency / 16);
  double sum = 0;
  for (std::size_t x = 0; x < block_size; ++x) {
    // Beyond the block its cosines go on as in a mirror.
    const double middle = static_cast<double>(2 * x + 1) / (2 * pixels);
    sum += cosine_of_pixel(to, x) * std::cos(std::numbers::pi * frequency * middle);
  }
  return scale * sum;
}

FREQSYNTH_INLINE AxisMap::AxisMap(Kind kind, std::size_t part, std::size_t factor) {
  for (std::size_t i = 0; i < block_size; ++i) {
    for (std::size_t j = 0; j < block_size; ++j) {
      const double weight = kind == Kind::shrink    ? shrinking_weight(i, j, part, factor)
                            : kind == Kind::enlarge ? enlarging_weight(i, j, part, factor)
                                                    : extending_weight(i, j, factor);
      to_from_[i * block_size + j] = from_to_[j * block_size + i] = static_cast<float>(weight);
    }
  }
}

}  // namespace freqsynth::detail
