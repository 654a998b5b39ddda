// SPDX-License-Identifier: MIT
/// \file
/// What is kept for every pixel of channels without coefficients: the sample nearest to its centre,
/// for what must not be averaged, or the mean of its samples.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/channel_settings.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// Keeps two floats for each pixel and channel; nothing without channels.
class PixelStore {
 public:
  /// No sample yet.
  /// \param roles  of its channels, none of which has_coefficients()
  PixelStore(const BlockGrid& grid, std::span<const ChannelRole> roles);

  /// Number of channels.
  [[nodiscard]] std::size_t channels() const { return roles_.size(); }
  /// A copy of the channels of a role.
  [[nodiscard]] PixelStore part(ChannelRole role) const;

  /// Takes in the values of a sample, one per channel. Where samples are averaged, those that are
  /// not is_usable_sample() are none; else those that are NaN. A point on the border of pixels lies
  /// in each of them. Of samples that are equally near the first one stays. Means depend on the
  /// order of the samples by rounding.
  /// \return whether all were taken
  bool add(const BlockGrid::Point& point, const float* values);

  /// The values of a channel in all pixels, row by row. What a pixel without a sample has:
  /// * ChannelRole::nearest: the value of the nearest pixel of its block that has one, by their
  ///   centres; of those that are equally near, of the first one, row by row. 0 where there is
  ///   none.
  /// * others: the mean of the samples in the smallest square around it that has one, of 3 x 3 to
  ///   17 x 17 pixels. 0 where there is none.
  [[nodiscard]] std::vector<float> pixels(std::size_t channel) const;

  /// What some samples have together.
  struct Sum {
    double count = 0;  ///< of samples
    double sum = 0;    ///< of their values
  };
  /// The samples of a channel that is averaged in a pixel and in those up to `reach` away along
  /// both axes.
  [[nodiscard]] Sum around(std::size_t x, std::size_t y, std::size_t channel,
                           std::size_t reach) const;

 private:
  friend struct StateArchive;

  /// Of one channel in one pixel: the mean of so many samples, or a sample and the square of its
  /// distance from the centre.
  struct Kept {
    static constexpr float far = std::numeric_limits<float>::max();  // no sample is

    float value = 0;
    float count_or_distance = 0;
  };

  [[nodiscard]] const Kept& kept(std::size_t x, std::size_t y, std::size_t channel) const {
    return kept_[(y * grid_.width + x) * channels() + channel];
  }
  [[nodiscard]] float nearest(std::size_t x, std::size_t y, std::size_t channel) const;
  [[nodiscard]] float mean(std::size_t x, std::size_t y, std::size_t channel) const;

  [[nodiscard]] bool averaged(std::size_t channel) const {
    return roles_[channel] != ChannelRole::nearest;
  }

  BlockGrid grid_;
  std::vector<ChannelRole> roles_;
  std::vector<Kept> kept_;  // [pixel][channel]
};

// ------------------------------------------------------------------------------------ definitions

inline PixelStore::PixelStore(const BlockGrid& grid, std::span<const ChannelRole> roles)
    : grid_(grid),
      roles_(roles.begin(), roles.end()),
      kept_(grid.width * grid.height * roles.size()) {
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (!averaged(i % channels())) kept_[i].count_or_distance = Kept::far;
  }
}

inline PixelStore PixelStore::part(ChannelRole role) const {
  std::vector<ChannelRole> roles;
  std::vector<std::size_t> taken;
  for (std::size_t c = 0; c < channels(); ++c) {
    if (roles_[c] == role) taken.push_back(c);
  }
  roles.assign(taken.size(), role);
  PixelStore some(grid_, roles);
  Kept* to = some.kept_.data();
  for (std::size_t first = 0; first < kept_.size(); first += channels()) {
    for (const std::size_t c : taken) *to++ = kept_[first + c];
  }
  return some;
}

inline bool PixelStore::add(const BlockGrid::Point& point, const float* values) {
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
  const std::size_t count = channels();
  bool all = true;
  for (std::size_t y = down.first; y <= down.last; ++y) {
    for (std::size_t x = across.first; x <= across.last; ++x) {
      const double right = point.x - (left + static_cast<double>(x) + 0.5);
      const double below = point.y - (top + static_cast<double>(y) + 0.5);
      const auto distance = static_cast<float>(right * right + below * below);
      Kept* pixel = kept_.data() + (y * grid_.width + x) * count;
      for (std::size_t c = 0; c < count; ++c) {
        Kept& own = pixel[c];
        if (averaged(c)) {
          if (!is_usable_sample(values[c])) {
            all = false;
            continue;
          }
          // Unlike a sum it stays in the range of the values.
          own.count_or_distance += 1;
          own.value += (values[c] - own.value) / own.count_or_distance;
        } else if (detail::is_nan(values[c])) {
          all = false;
        } else if (distance < own.count_or_distance) {
          own = {values[c], distance};
        }
      }
    }
  }
  return all;
}

inline float PixelStore::nearest(std::size_t x, std::size_t y, std::size_t channel) const {
  const Kept& own = kept(x, y, channel);
  if (own.count_or_distance < Kept::far) return own.value;
  const std::size_t left = x / block_size * block_size, top = y / block_size * block_size;
  const std::size_t right = std::min<std::size_t>(left + block_size, grid_.width);
  const std::size_t bottom = std::min<std::size_t>(top + block_size, grid_.height);
  std::size_t least = std::numeric_limits<std::size_t>::max();
  float nearest = 0;
  for (std::size_t v = top; v < bottom; ++v) {
    for (std::size_t u = left; u < right; ++u) {
      // Differences of unsigned numbers, whose squares are right also where they are below 0.
      const std::size_t distance = (u - x) * (u - x) + (v - y) * (v - y);
      if (distance >= least || !(kept(u, v, channel).count_or_distance < Kept::far)) continue;
      least = distance;
      nearest = kept(u, v, channel).value;
    }
  }
  return nearest;
}

inline float PixelStore::mean(std::size_t x, std::size_t y, std::size_t channel) const {
  const Kept& own = kept(x, y, channel);
  if (own.count_or_distance > 0) return own.value;
  // As far as the samples of a block can be from its pixels.
  for (std::size_t reach = 1; reach <= block_size; ++reach) {
    const Sum all = around(x, y, channel, reach);
    if (all.count > 0) return static_cast<float>(all.sum / all.count);
  }
  return 0;
}

inline PixelStore::Sum PixelStore::around(std::size_t x, std::size_t y, std::size_t channel,
                                          std::size_t reach) const {
  Sum all;
  const std::size_t right = std::min(x + reach, grid_.width - 1);
  const std::size_t bottom = std::min(y + reach, grid_.height - 1);
  for (std::size_t v = y - std::min(y, reach); v <= bottom; ++v) {
    for (std::size_t u = x - std::min(x, reach); u <= right; ++u) {
      const Kept& there = kept(u, v, channel);
      all.count += double{there.count_or_distance};
      all.sum += double{there.count_or_distance} * double{there.value};
    }
  }
  return all;
}

inline std::vector<float> PixelStore::pixels(std::size_t channel) const {
  std::vector<float> pixels;
  pixels.reserve(grid_.width * grid_.height);
  for (std::size_t y = 0; y < grid_.height; ++y) {
    for (std::size_t x = 0; x < grid_.width; ++x) {
      pixels.push_back(averaged(channel) ? mean(x, y, channel) : nearest(x, y, channel));
    }
  }
  return pixels;
}

}  // namespace freqsynth
