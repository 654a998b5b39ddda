// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/linear_blend.h"
#include "freqsynth/image/lone_peaks.h"
#include "freqsynth/image/ranked_blocks.h"
#include "freqsynth/image/rare_light.h"

namespace freqsynth {
namespace detail {

/// Of each block the value that half of those around do not exceed.
inline std::vector<double> usual_around(std::span<const double> values, std::size_t blocks_x,
                                        const ExecutorRef& executor) {
  constexpr std::size_t reach = 4;
  constexpr double half = 0.5;
  std::vector<RankedBlocks::Value> places(values.size());
  for (std::size_t block = 0; block < values.size(); ++block) {
    places[block] = {values[block], static_cast<std::uint32_t>(block)};
  }
  const RankedBlocks ranked(std::move(places), blocks_x, values.size());
  std::vector<double> usual(values.size());
  share_pieces(executor, values.size() / blocks_x, [&](std::size_t row) {
    ranked.usual(row, reach, half, std::span(usual).subspan(row * blocks_x, blocks_x));
  });
  return usual;
}

FREQSYNTH_INLINE RareLight::RareLight(const NoisyPicture& picture, std::size_t channel,
                                      const ExecutorRef& executor)
    : picture_(picture),
      channel_(channel),
      blocks_x_(picture.width / block_size),
      blocks_y_(picture.height / block_size),
      light_(picture.width * picture.height) {
  if (light_.empty()) return;
  const NoisyPicture::Plane& variances = picture.variances[channel];
  const std::vector<double> usual =
      usual_around(std::vector<double>(variances.begin(), variances.end()), blocks_x_, executor);
  const NoisyPicture::Plane without_peaks = LonePeaks(picture, channel).removed(executor);
  const std::vector<double> levels = usual_levels(picture.pixels[channel], executor);
  share_pieces(executor, blocks_y_,
               [&](std::size_t row) { find(row, without_peaks, usual, levels); });
}

/// In a row of blocks.
FREQSYNTH_INLINE void RareLight::find(std::size_t row, std::span<const float> without_peaks,
                                      std::span<const double> variances,
                                      std::span<const double> levels) {
  constexpr std::size_t near = 1, far = 2;
  constexpr double many_deviations = 6, most_others = 3;
  const std::size_t width = picture_.width;
  const NoisyPicture::Plane& sums = picture_.sums[channel_];
  const NoisyPicture::Plane& pixels = picture_.pixels[channel_];
  const auto around = [&](std::size_t pixel, std::size_t reach, const auto& visit) {
    const std::size_t x = pixel % width, y = pixel / width;
    for (std::size_t v = y - std::min(y, reach); v < std::min(y + reach + 1, picture_.height);
         ++v) {
      for (std::size_t u = x - std::min(x, reach); u < std::min(x + reach + 1, width); ++u) {
        visit(v * width + u);
      }
    }
  };
  const auto above = [&](std::size_t pixel, double level) {
    return std::max(0.0, static_cast<double>(sums[pixel]) -
                             static_cast<double>(picture_.weights[pixel]) * level);
  };
  for (std::size_t pixel = row * block_size * width; pixel < (row + 1) * block_size * width;
       ++pixel) {
    const auto samples = static_cast<double>(picture_.weights[pixel]);
    if (!(samples > 0)) continue;
    const std::size_t block = row * blocks_x_ + pixel % width / block_size;
    // Of light there is noise up to its own level, seen or not; and edges are no rare light.
    const double variance = std::max(variances[block], levels[block] * levels[block]);
    const double noise = many_deviations * many_deviations * samples * variance;
    const auto sum = static_cast<double>(sums[pixel]);
    if (!(sum > 0 && sum * sum > noise)) continue;
    // The sample that has made a peak may lie beside it.
    float level = std::numeric_limits<float>::infinity();
    around(pixel, near, [&](std::size_t other) {
      if (without_peaks[other] < pixels[other]) level = std::min(level, without_peaks[other]);
    });
    if (level == std::numeric_limits<float>::infinity()) continue;
    const double light = above(pixel, static_cast<double>(level));
    if (!(light * light > noise)) continue;
    double others = 0;  // their number, those with less of it as a part
    around(pixel, far, [&](std::size_t other) {
      if (other != pixel) others += std::min(1.0, above(other, static_cast<double>(level)) / light);
    });
    if (others <= most_others) light_[pixel] = static_cast<float>(light);
  }
}

FREQSYNTH_INLINE bool RareLight::any() const {
  return std::any_of(light_.begin(), light_.end(), [](float light) { return light > 0; });
}

FREQSYNTH_INLINE NoisyPicture::Plane RareLight::other_sums() const {
  NoisyPicture::Plane others = picture_.sums[channel_];
  for (std::size_t pixel = 0; pixel < others.size(); ++pixel) others[pixel] -= light_[pixel];
  return others;
}

/// Values of blocks, added up with weights that fall linearly along both axes.
FREQSYNTH_INLINE std::vector<double> RareLight::spread_around(std::vector<double> values) const {
  constexpr std::size_t reach = 7;
  std::vector<double> rows(values.size());
  const auto add_up = [&](const double* from, double* to, std::size_t count, std::size_t step) {
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0;
      for (std::size_t j = i - std::min(i, reach); j < std::min(i + reach + 1, count); ++j) {
        sum += static_cast<double>(reach + 1 - (i > j ? i - j : j - i)) * from[j * step];
      }
      to[i * step] = sum;
    }
  };
  for (std::size_t y = 0; y < blocks_y_; ++y) {
    add_up(&values[y * blocks_x_], &rows[y * blocks_x_], blocks_x_, 1);
  }
  for (std::size_t x = 0; x < blocks_x_; ++x) add_up(&rows[x], &values[x], blocks_y_, blocks_x_);
  return values;
}

/// Of blocks, without those of small lamps.
FREQSYNTH_INLINE std::vector<double> RareLight::usual_levels(std::span<const float> pixels,
                                                             const ExecutorRef& executor) const {
  std::vector<double> levels(blocks_x_ * blocks_y_);
  share_pieces(executor, blocks_y_, [&](std::size_t row) {
    for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
      for (std::size_t x = 0; x < picture_.width; ++x) {
        levels[row * blocks_x_ + x / block_size] +=
            std::max(0.0, static_cast<double>(pixels[y * picture_.width + x])) / max_terms;
      }
    }
  });
  return usual_around(levels, blocks_x_, executor);
}

FREQSYNTH_INLINE void RareLight::spread(std::span<float> pixels,
                                        const ExecutorRef& executor) const {
  const std::size_t width = picture_.width;
  double light = 0, samples = 0;
  for (std::size_t pixel = 0; pixel < light_.size(); ++pixel) {
    light += static_cast<double>(light_[pixel]);
    samples += static_cast<double>(picture_.weights[pixel]);
  }
  if (!(light > 0)) return;
  // Where all is dark it goes everywhere.
  const double least = 0.1 * light / samples;
  const std::vector<double> usual = usual_levels(pixels, executor);
  const auto columns =
      blends_along(width, block_size, blocks_x_, static_cast<double>(blocks_x_ - 1));
  const auto rows =
      blends_along(picture_.height, block_size, blocks_y_, static_cast<double>(blocks_y_ - 1));
  std::vector<double> shares(pixels.size());
  share_pieces(executor, blocks_y_, [&](std::size_t row) {
    for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t pixel = y * width + x;
        const double most = blended(usual.data(), blocks_x_, columns[x], rows[y]);
        shares[pixel] = std::clamp(static_cast<double>(pixels[pixel]), 0.0, most) + least;
      }
    }
  });
  // What blocks give to pixels is blended between their centres, and counts there by its share.
  std::vector<double> lights(blocks_x_ * blocks_y_), weights(lights.size());
  share_pieces(executor, blocks_y_, [&](std::size_t row) {
    double* const own = &weights[row * blocks_x_];
    const std::size_t first = row * block_size, half = block_size / 2;
    for (std::size_t y = first - std::min(first, half);
         y < std::min(first + block_size + half, picture_.height); ++y) {
      const double share = (rows[y].first == row ? 1 - rows[y].share : 0) +
                           (rows[y].second == row ? rows[y].share : 0);
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t pixel = y * width + x;
        const double weight = share * shares[pixel] * static_cast<double>(picture_.weights[pixel]);
        own[columns[x].first] += (1 - columns[x].share) * weight;
        own[columns[x].second] += columns[x].share * weight;
        if (y / block_size != row) continue;
        lights[row * blocks_x_ + x / block_size] += static_cast<double>(light_[pixel]);
      }
    }
  });
  const std::vector<double> weights_around = spread_around(weights);
  for (std::size_t block = 0; block < lights.size(); ++block) {
    lights[block] = lights[block] > 0 ? lights[block] / weights_around[block] : 0;
  }
  lights = spread_around(std::move(lights));
  share_pieces(executor, blocks_y_, [&](std::size_t row) {
    for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t pixel = y * width + x;
        pixels[pixel] += static_cast<float>(shares[pixel] *
                                            blended(lights.data(), blocks_x_, columns[x], rows[y]));
      }
    }
  });
}

}  // namespace detail
}  // namespace freqsynth
