// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "freqsynth/image/block_noise.h"

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
};

/// Of all blocks, row by row.
inline std::vector<BlockResidual> block_residuals(const NoisyPicture& picture,
                                                  std::span<const float> sums,
                                                  std::span<const float> pixels) {
  const std::size_t blocks_x = picture.width / block_size;
  std::vector<BlockResidual> blocks(blocks_x * (picture.height / block_size));
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const std::size_t pixel = y * picture.width + x;
      BlockResidual& block = blocks[y / block_size * blocks_x + x / block_size];
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
  return blocks;
}

/// Pixels along one axis, and lines of them.
struct Lines {
  std::size_t lines, length;  ///< how many, and of how many pixels
  std::size_t line, step;     ///< from a line to the next, and from a pixel of it to the next
};

/// Closes the borders that lie across lines.
/// \param noise  of the blocks on both sides: variance of the mean of a pixel
template <class Noise>
void close_borders_across(const Lines& all, double variance, Noise&& noise,
                          std::span<float> pixels) {
  constexpr std::size_t half = block_size / 2, reach = 3;
  std::vector<double> steps(all.lines);
  for (std::size_t border = block_size; border < all.length; border += block_size) {
    const auto at = [&](std::size_t line, std::size_t place) -> float& {
      return pixels[line * all.line + place * all.step];
    };
    for (std::size_t i = 0; i < all.lines; ++i) {
      const auto value = [&](std::size_t place) { return static_cast<double>(at(i, place)); };
      steps[i] = 1.5 * value(border) - 0.5 * value(border + 1) -
                 (1.5 * value(border - 1) - 0.5 * value(border - 2));
    }
    for (std::size_t i = 0; i < all.lines; ++i) {
      double sum = 0, weights = 0;
      for (std::size_t j = i - std::min(i, reach); j < std::min(i + reach + 1, all.lines); ++j) {
        const auto weight = static_cast<double>(reach + 1 - (i > j ? i - j : j - i));
        sum += weight * steps[j];
        weights += weight;
      }
      const double step = sum / weights;
      const double expected = variance * noise(i / block_size, border / block_size);
      if (!(expected > 0)) continue;
      const double back = step * expected / (step * step + expected);
      for (std::size_t d = 0; d < half; ++d) {
        const double share = 0.5 - (static_cast<double>(d) + 0.5) / block_size;
        at(i, border - 1 - d) += static_cast<float>(share * back);
        at(i, border + d) -= static_cast<float>(share * back);
      }
    }
  }
}

FREQSYNTH_INLINE void close_borders(const NoisyPicture& picture, std::span<const float> sums,
                                    double variance, std::span<float> pixels) {
  const std::vector<BlockResidual> blocks = block_residuals(picture, sums, pixels);
  const std::size_t blocks_x = picture.width / block_size;
  const auto noise = [&](std::size_t first, std::size_t second) {
    const BlockResidual &a = blocks[first], &b = blocks[second];
    const double pixels_per_sample =
        0.5 * max_terms * (1 / std::max(1.0, a.samples) + 1 / std::max(1.0, b.samples));
    return BlockResidual::variance(a, b) * pixels_per_sample;
  };
  close_borders_across(
      {picture.height, picture.width, picture.width, 1}, variance,
      [&](std::size_t y, std::size_t x) { return noise(y * blocks_x + x - 1, y * blocks_x + x); },
      pixels);
  close_borders_across(
      {picture.width, picture.height, 1, picture.width}, variance,
      [&](std::size_t x, std::size_t y) { return noise((y - 1) * blocks_x + x, y * blocks_x + x); },
      pixels);
}

/// How far each block's level is from what it is to be.
inline std::vector<double> level_corrections(const std::vector<BlockResidual>& blocks,
                                             std::size_t blocks_x) {
  constexpr std::size_t reach = 4;
  constexpr double usual = 0.65;  // a share of blocks
  const std::size_t blocks_y = blocks.size() / blocks_x;
  std::vector<double> corrections(blocks.size()), variances;
  const auto visit_around = [&](std::size_t x, std::size_t y, auto&& visit) {
    for (std::size_t v = y - std::min(y, reach); v < std::min(y + reach + 1, blocks_y); ++v) {
      for (std::size_t u = x - std::min(x, reach); u < std::min(x + reach + 1, blocks_x); ++u) {
        const std::size_t across = u > x ? u - x : x - u, down = v > y ? v - y : y - v;
        visit(blocks[v * blocks_x + u],
              static_cast<double>((reach + 1 - across) * (reach + 1 - down)));
      }
    }
  };
  for (std::size_t y = 0; y < blocks_y; ++y) {
    for (std::size_t x = 0; x < blocks_x; ++x) {
      double shares = 0, samples = 0, sum = 0;
      variances.clear();
      visit_around(x, y, [&](const BlockResidual& block, double share) {
        if (!(block.sampled > 0)) return;
        shares += share;
        samples += share * block.samples;
        sum += share * (block.samples * block.level + block.sum);
        variances.push_back(block.variance());
      });
      if (variances.empty()) continue;
      const double mean = sum / samples;
      // Not the mean: a part of the picture with far more noise must not speak for the others.
      const auto place = variances.begin() + static_cast<std::ptrdiff_t>(
                                                 usual * static_cast<double>(variances.size() - 1));
      std::nth_element(variances.begin(), place, variances.end());
      const double variance = *place;  // of a sample
      double spread = 0;               // of the levels
      visit_around(x, y, [&](const BlockResidual& block, double share) {
        spread += share * block.samples * (block.level - mean) * (block.level - mean);
      });
      const double signal = std::max(0.0, (spread - shares * variance) / samples);
      const BlockResidual& own = blocks[y * blocks_x + x];
      const double noise = variance / std::max(1.0, own.samples);
      if (!(noise > 0)) continue;
      corrections[y * blocks_x + x] = noise / (signal + noise) * (mean - own.level);
    }
  }
  return corrections;
}

FREQSYNTH_INLINE void pool_levels(const NoisyPicture& picture, std::span<const float> sums,
                                  std::span<float> pixels) {
  constexpr int times = 4;  // each reaches further
  const std::size_t blocks_x = picture.width / block_size;
  const std::size_t blocks_y = picture.height / block_size;
  // The two blocks whose middles are nearest along an axis, and the second one's share.
  const auto beside = [](std::size_t pixel, std::size_t blocks) {
    const double place = (static_cast<double>(pixel) + 0.5) / block_size - 0.5;
    const double first = std::clamp(place, 0.0, static_cast<double>(blocks - 1));
    const auto low = static_cast<std::size_t>(first);
    return std::pair{low, first - static_cast<double>(low)};
  };
  for (int i = 0; i < times; ++i) {
    const std::vector<double> corrections =
        level_corrections(block_residuals(picture, sums, pixels), blocks_x);
    for (std::size_t y = 0; y < picture.height; ++y) {
      const auto [row, down] = beside(y, blocks_y);
      const double* above = &corrections[row * blocks_x];
      const double* below = down > 0 ? above + blocks_x : above;
      for (std::size_t x = 0; x < picture.width; ++x) {
        const auto [column, right] = beside(x, blocks_x);
        const std::size_t next = right > 0 ? column + 1 : column;
        const double correction = (1 - down) * ((1 - right) * above[column] + right * above[next]) +
                                  down * ((1 - right) * below[column] + right * below[next]);
        pixels[y * picture.width + x] += static_cast<float>(correction);
      }
    }
  }
}

}  // namespace detail
}  // namespace freqsynth
