// SPDX-License-Identifier: MIT
// How the levels of blocks are drawn to those around.
#pragma once

#include "freqsynth/image/linear_blend.h"

namespace freqsynth {
namespace detail {

/// Of all blocks, with room around each row and rows above and below, in which nothing is.
class BlockLevels {
 public:
  static constexpr std::size_t reach = 4;

  BlockLevels(const std::vector<BlockResidual>& blocks, const std::vector<BlockResidual>& noise,
              std::size_t blocks_x)
      : blocks_x_(blocks_x),
        blocks_y_(blocks.size() / blocks_x),
        stride_(blocks_x + 2 * reach),
        known_(stride_ * blocks_y_),
        samples_(known_),
        sums_(known_),
        levels_(known_),
        variances_(known_variances(noise), blocks_x, blocks.size()) {
    for (std::size_t block = 0; block < blocks.size(); ++block) {
      const BlockResidual& one = blocks[block];
      const std::size_t at = block / blocks_x * stride_ + block % blocks_x + reach;
      levels_[at] = one.level;
      if (!(one.sampled > 0)) continue;
      known_[at] = 1;
      samples_[at] = one.samples;
      sums_[at] = one.samples * one.level + one.sum;
    }
  }

  /// How far the level of each block of a row is from what it is to be.
  void corrections(std::size_t row, std::span<double> out) const;

 private:
  static std::vector<RankedBlocks::Value> known_variances(
      const std::vector<BlockResidual>& blocks) {
    std::vector<RankedBlocks::Value> known;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
      if (!(blocks[block].sampled > 0)) continue;
      known.push_back({blocks[block].variance(), static_cast<std::uint32_t>(block)});
    }
    return known;
  }
  /// Calls visit(weight, place) with the place of what is beside a row's first block, for all that
  /// are around.
  template <class Visit>
  void visit_around(std::size_t row, Visit&& visit) const {
    for (std::size_t v = row - std::min(row, reach); v < std::min(row + reach + 1, blocks_y_);
         ++v) {
      const std::size_t down = v > row ? v - row : row - v;
      for (std::size_t u = 0; u <= 2 * reach; ++u) {
        const std::size_t across = u > reach ? u - reach : reach - u;
        visit(static_cast<double>((reach + 1 - across) * (reach + 1 - down)), v * stride_ + u);
      }
    }
  }

  std::size_t blocks_x_, blocks_y_, stride_;
  std::vector<double> known_, samples_, sums_, levels_;
  RankedBlocks variances_;
};

inline void BlockLevels::corrections(std::size_t row, std::span<double> out) const {
  std::vector<double> shares(blocks_x_), samples(blocks_x_), means(blocks_x_), spread(blocks_x_);
  std::vector<double> variances(blocks_x_);
  // One that most do not exceed: not the mean, for a part of the picture with far more noise must
  // not speak for the others.
  constexpr double usual = 0.65;  // a share of blocks
  // One block around after the other, of all blocks of the row.
  visit_around(row, [&](double share, std::size_t place) {
    for (std::size_t x = 0; x < blocks_x_; ++x) {
      shares[x] += share * known_[place + x];
      samples[x] += share * samples_[place + x];
      means[x] += share * sums_[place + x];
    }
  });
  for (std::size_t x = 0; x < blocks_x_; ++x) {
    means[x] = shares[x] > 0 ? means[x] / samples[x] : 0;
  }
  visit_around(row, [&](double share, std::size_t place) {
    for (std::size_t x = 0; x < blocks_x_; ++x) {
      const double difference = levels_[place + x] - means[x];
      spread[x] += share * samples_[place + x] * difference * difference;
    }
  });
  variances_.usual(row, reach, usual, variances);
  for (std::size_t x = 0; x < blocks_x_; ++x) {
    out[x] = 0;
    if (!(shares[x] > 0)) continue;
    const std::size_t own = row * stride_ + x + reach;
    const double signal = std::max(0.0, (spread[x] - shares[x] * variances[x]) / samples[x]);
    const double noise = variances[x] / std::max(1.0, samples_[own]);
    if (!(noise > 0)) continue;
    // Nothing below a quarter, all from 3/8 on.
    const double share = noise / (signal + noise);
    out[x] = share * std::clamp(8 * share - 2, 0.0, 1.0) * (means[x] - levels_[own]);
  }
}

FREQSYNTH_INLINE void pool_levels(const NoisyPicture& picture, std::span<const float> sums,
                                  std::span<const float> all_sums, std::span<float> pixels,
                                  const ExecutorRef& executor) {
  constexpr int times = 4;  // each reaches further
  const std::size_t blocks_x = picture.width / block_size;
  const std::size_t blocks_y = picture.height / block_size;
  if (blocks_x * blocks_y == 0) return;
  const std::vector<LinearBlend<double>> columns =
      blends_along(picture.width, block_size, blocks_x, static_cast<double>(blocks_x - 1));
  const std::vector<LinearBlend<double>> rows =
      blends_along(picture.height, block_size, blocks_y, static_cast<double>(blocks_y - 1));
  std::vector<double> corrections(blocks_x * blocks_y);
  for (int i = 0; i < times; ++i) {
    const std::vector<BlockResidual> blocks = block_residuals(picture, sums, pixels, executor);
    const bool same = sums.data() == all_sums.data();
    const BlockLevels levels(
        blocks, same ? blocks : block_residuals(picture, all_sums, pixels, executor), blocks_x);
    share_pieces(executor, blocks_y, [&](std::size_t row) {
      levels.corrections(row, std::span(corrections).subspan(row * blocks_x, blocks_x));
    });
    share_pieces(executor, blocks_y, [&](std::size_t row) {
      for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
        for (std::size_t x = 0; x < picture.width; ++x) {
          const double correction = blended(corrections.data(), blocks_x, columns[x], rows[y]);
          pixels[y * picture.width + x] += static_cast<float>(correction);
        }
      }
    });
  }
}

}  // namespace detail
}  // namespace freqsynth
