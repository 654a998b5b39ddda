// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/block_noise.h"
#include "freqsynth/image/ranked_blocks.h"

namespace freqsynth {
namespace detail {

/// What the samples of a block say of its pixels.
struct BlockResidual {
  double samples = 0;  ///< their number
  double sampled = 0;  ///< pixels with samples
  double squares = 0;  ///< sum of the squared differences of pixels' means, by their samples
  double sum = 0;      ///< sum of the differences of the samples
  double level = 0;    ///< mean of the pixels

  /// Variance of a sample.
  [[nodiscard]] double variance() const { return squares / std::max(1.0, sampled); }
  /// The same of two blocks together.
  [[nodiscard]] static double variance(const BlockResidual& a, const BlockResidual& b) {
    return (a.squares + b.squares) / std::max(1.0, a.sampled + b.sampled);
  }
  /// Variance that noise gives to the mean of a pixel, beside a border of two blocks.
  [[nodiscard]] static double of_pixel(const BlockResidual& a, const BlockResidual& b) {
    const double pixels_per_sample =
        0.5 * max_terms * (1 / std::max(1.0, a.samples) + 1 / std::max(1.0, b.samples));
    return variance(a, b) * pixels_per_sample;
  }
};

/// Of all blocks, row by row.
inline std::vector<BlockResidual> block_residuals(const NoisyPicture& picture,
                                                  std::span<const float> sums,
                                                  std::span<const float> pixels,
                                                  const ExecutorRef& executor) {
  const std::size_t blocks_x = picture.width / block_size;
  std::vector<BlockResidual> blocks(blocks_x * (picture.height / block_size));
  share_pieces(executor, picture.height / block_size, [&](std::size_t row) {
    for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
      for (std::size_t x = 0; x < picture.width; ++x) {
        const std::size_t pixel = y * picture.width + x;
        BlockResidual& block = blocks[row * blocks_x + x / block_size];
        const auto value = static_cast<double>(pixels[pixel]);
        block.level += value / max_terms;
        const auto weight = static_cast<double>(picture.weights[pixel]);
        if (!(weight > 0)) continue;
        const double difference = static_cast<double>(sums[pixel]) / weight - value;
        block.samples += weight;
        block.sampled += 1;
        block.squares += weight * difference * difference;
        block.sum += weight * difference;
      }
    }
  });
  return blocks;
}

/// Steps along a border are averaged over so many on each side.
inline constexpr std::size_t border_reach = 3;

/// Of a line across a border: the step, extrapolated from two pixels on either side.
inline double border_step(const float* after, std::ptrdiff_t next) {
  const auto value = [&](std::ptrdiff_t place) { return static_cast<double>(after[place * next]); };
  return 1.5 * value(0) - 0.5 * value(1) - (1.5 * value(-1) - 0.5 * value(-2));
}

/// Spreads what is to be taken back of a step over the pixels on both sides.
inline void take_back(double step, double expected, float* after, std::ptrdiff_t next) {
  const double back = step * expected / (step * step + expected);
  for (std::ptrdiff_t d = 0; d < static_cast<std::ptrdiff_t>(block_size / 2); ++d) {
    const double share = 0.5 - (static_cast<double>(d) + 0.5) / block_size;
    after[(-1 - d) * next] += static_cast<float>(share * back);
    after[d * next] -= static_cast<float>(share * back);
  }
}

/// The borders between blocks side by side. All steps are known before any is taken back.
inline void close_upright_borders(const NoisyPicture& picture,
                                  const std::vector<BlockResidual>& blocks, double variance,
                                  std::span<float> pixels, const ExecutorRef& executor) {
  const std::size_t blocks_x = picture.width / block_size, borders = blocks_x - 1;
  const std::size_t height = picture.height;
  if (borders == 0) return;
  std::vector<double> steps(height * borders);
  share_pieces(executor, height / block_size, [&](std::size_t row) {
    for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
      const float* line = &pixels[y * picture.width];
      for (std::size_t border = 0; border < borders; ++border) {
        steps[y * borders + border] = border_step(line + (border + 1) * block_size, 1);
      }
    }
  });
  share_work(executor, height / block_size, [&](WorkPieces& rows) {
    std::vector<double> sums(borders);
    for (std::size_t row; rows.take(row);) {
      for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
        std::fill(sums.begin(), sums.end(), 0.0);
        double weights = 0;
        for (std::size_t j = y - std::min(y, border_reach);
             j < std::min(y + border_reach + 1, height); ++j) {
          const auto weight = static_cast<double>(border_reach + 1 - (y > j ? y - j : j - y));
          const double* other = &steps[j * borders];
          for (std::size_t border = 0; border < borders; ++border) {
            sums[border] += weight * other[border];
          }
          weights += weight;
        }
        for (std::size_t border = 0; border < borders; ++border) {
          const BlockResidual* beside = &blocks[row * blocks_x + border];
          const double expected = variance * BlockResidual::of_pixel(beside[0], beside[1]);
          if (!(expected > 0)) continue;
          take_back(sums[border] / weights, expected,
                    &pixels[y * picture.width + (border + 1) * block_size], 1);
        }
      }
    }
  });
}

/// The borders between blocks above each other, each of which has pixels of its own.
inline void close_level_borders(const NoisyPicture& picture,
                                const std::vector<BlockResidual>& blocks, double variance,
                                std::span<float> pixels, const ExecutorRef& executor) {
  const std::size_t width = picture.width, blocks_x = width / block_size;
  const auto next = static_cast<std::ptrdiff_t>(width);
  share_work(executor, picture.height / block_size - 1, [&](WorkPieces& borders) {
    std::vector<double> steps(width);
    for (std::size_t border; borders.take(border);) {
      float* after = &pixels[(border + 1) * block_size * width];
      for (std::size_t x = 0; x < width; ++x) steps[x] = border_step(after + x, next);
      const BlockResidual* above = &blocks[border * blocks_x];
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t block = x / block_size;
        const double expected =
            variance * BlockResidual::of_pixel(above[block], above[blocks_x + block]);
        if (!(expected > 0)) continue;
        double sum = 0, weights = 0;
        for (std::size_t j = x - std::min(x, border_reach);
             j < std::min(x + border_reach + 1, width); ++j) {
          const auto weight = static_cast<double>(border_reach + 1 - (x > j ? x - j : j - x));
          sum += weight * steps[j];
          weights += weight;
        }
        take_back(sum / weights, expected, after + x, next);
      }
    }
  });
}

FREQSYNTH_INLINE void close_borders(const NoisyPicture& picture, std::span<const float> sums,
                                    double variance, std::span<float> pixels,
                                    const ExecutorRef& executor) {
  const std::vector<BlockResidual> blocks = block_residuals(picture, sums, pixels, executor);
  if (blocks.empty()) return;
  close_upright_borders(picture, blocks, variance, pixels, executor);
  close_level_borders(picture, blocks, variance, pixels, executor);
}

}  // namespace detail
}  // namespace freqsynth

#include "freqsynth/image/block_noise_levels.inl"
