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

FREQSYNTH_INLINE AxisMap::AxisMap(std::size_t part, std::size_t factor, bool enlarge) {
  const auto cosine = [](std::size_t u, std::size_t x) {
    const double angle = static_cast<double>((2 * x + 1) * u) * std::numbers::pi / 16;
    return 0.5 * kappa(u) * std::cos(angle);
  };
  for (std::size_t i = 0; i < block_size; ++i) {
    for (std::size_t j = 0; j < block_size; ++j) {
      // Pixel x of the fine block lies in pixel (8 part + x) / factor of the coarse one.
      double sum = 0;
      for (std::size_t x = 0; x < block_size; ++x) {
        const std::size_t coarse = (part * block_size + x) / factor;
        sum += enlarge ? cosine(i, x) * cosine(j, coarse)
                       : cosine(i, coarse) * cosine(j, x) / static_cast<double>(factor);
      }
      to_from_[i * block_size + j] = from_to_[j * block_size + i] = static_cast<float>(sum);
    }
  }
}

}  // namespace freqsynth::detail
