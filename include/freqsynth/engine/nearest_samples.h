// SPDX-License-Identifier: MIT
/// \file
/// For every pixel the sample nearest to its centre: for channels that must not be averaged.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// Keeps a value and a distance for each pixel and channel, 8 bytes; nothing without channels.
class NearestSamples {
 public:
  /// No sample yet.
  NearestSamples(const BlockGrid& grid, std::size_t channels)
      : grid_(grid), channels_(channels), kept_(grid.width * grid.height * channels) {}

  /// Number of channels.
  [[nodiscard]] std::size_t channels() const { return channels_; }

  /// Takes in the values of a sample, one per channel; those that are NaN are none. A point on the
  /// border of pixels lies in each of them. Of samples that are equally near the first one stays.
  void add(const BlockGrid::Point& point, const float* values);

  /// The values of a channel in all pixels, row by row. A pixel without a sample has that of the
  /// nearest pixel of its block that has one, by their centres; of those that are equally near, of
  /// the first one, row by row. 0 where the block has none.
  [[nodiscard]] std::vector<float> pixels(std::size_t channel) const;

 private:
  friend struct StateArchive;

  struct Kept {
    float value = 0;
    float distance = std::numeric_limits<float>::max();  // squared; as large as this: no sample

    [[nodiscard]] bool any() const { return distance < std::numeric_limits<float>::max(); }
  };

  [[nodiscard]] const Kept& kept(std::size_t x, std::size_t y, std::size_t channel) const {
    return kept_[(y * grid_.width + x) * channels_ + channel];
  }
  [[nodiscard]] float value(std::size_t x, std::size_t y, std::size_t channel) const;

  BlockGrid grid_;
  std::size_t channels_;
  std::vector<Kept> kept_;  // [pixel][channel]
};

// ------------------------------------------------------------------------------------ definitions

inline void NearestSamples::add(const BlockGrid::Point& point, const float* values) {
  if (channels_ == 0) return;
  // The pixels along an axis that have a coordinate: one, or two that share their border.
  struct Pair {
    std::size_t first, last;
  };
  const auto around = [](double at, std::size_t pixels) {
    const auto below = static_cast<std::size_t>(at);
    const bool border = static_cast<double>(below) == at && below > 0;
    return Pair{border ? below - 1 : below, std::min(below, pixels - 1)};
  };
  const PixelWindow covered = grid_.covered();
  const double left = static_cast<double>(covered.x), top = static_cast<double>(covered.y);
  const Pair across = around(point.x - left, grid_.width);
  const Pair down = around(point.y - top, grid_.height);
  for (std::size_t y = down.first; y <= down.last; ++y) {
    for (std::size_t x = across.first; x <= across.last; ++x) {
      const double right = point.x - (left + static_cast<double>(x) + 0.5);
      const double below = point.y - (top + static_cast<double>(y) + 0.5);
      const auto distance = static_cast<float>(right * right + below * below);
      Kept* pixel = kept_.data() + (y * grid_.width + x) * channels_;
      for (std::size_t c = 0; c < channels_; ++c) {
        if (distance < pixel[c].distance && !detail::is_nan(values[c])) {
          pixel[c] = {values[c], distance};
        }
      }
    }
  }
}

inline float NearestSamples::value(std::size_t x, std::size_t y, std::size_t channel) const {
  const Kept& own = kept(x, y, channel);
  if (own.any()) return own.value;
  const std::size_t left = x / block_size * block_size, top = y / block_size * block_size;
  const std::size_t right = std::min<std::size_t>(left + block_size, grid_.width);
  const std::size_t bottom = std::min<std::size_t>(top + block_size, grid_.height);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  float nearest = 0;
  for (std::size_t v = top; v < bottom; ++v) {
    for (std::size_t u = left; u < right; ++u) {
      // Differences of unsigned numbers, whose squares are right also where they are below 0.
      const std::size_t distance = (u - x) * (u - x) + (v - y) * (v - y);
      if (distance >= least || !kept(u, v, channel).any()) continue;
      least = distance;
      nearest = kept(u, v, channel).value;
    }
  }
  return nearest;
}

inline std::vector<float> NearestSamples::pixels(std::size_t channel) const {
  std::vector<float> pixels;
  pixels.reserve(grid_.width * grid_.height);
  for (std::size_t y = 0; y < grid_.height; ++y) {
    for (std::size_t x = 0; x < grid_.width; ++x) pixels.push_back(value(x, y, channel));
  }
  return pixels;
}

}  // namespace freqsynth
