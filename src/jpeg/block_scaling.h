/// \file
/// Linear maps between blocks of pixels of different sizes, in frequencies.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/kernels.h"

namespace freqsynth::detail {

/// A block in rows of frequencies, [v][u], as the kernel reads it.
struct alignas(32) RowBlock {
  float values[max_terms];
};

/// A map of 8 frequencies of one axis to 8 others.
class AxisMap {
 public:
  /// Block `part` (of `factor` along the axis) to its share of the block of means of `factor`
  /// pixels.
  static AxisMap shrink(std::size_t part, std::size_t factor) { return {part, factor, false}; }

  /// A block to part `part` of the `factor` blocks in which each pixel is repeated `factor` times.
  static AxisMap enlarge(std::size_t part, std::size_t factor) { return {part, factor, true}; }

  /// The coefficients of the block after both axes.
  static RowBlock apply(const AxisMap& across, const AxisMap& down, const RowBlock& block) {
    RowBlock out;
    evaluate_separable(block.values, across.from_to_, block_size, block_size, down.to_from_,
                       block_size, out.values, block_size);
    return out;
  }

 private:
  AxisMap(std::size_t part, std::size_t factor, bool enlarge) {
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

  alignas(32) float to_from_[max_terms];
  alignas(32) float from_to_[max_terms];
};

}  // namespace freqsynth::detail
