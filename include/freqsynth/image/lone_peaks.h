// SPDX-License-Identifier: MIT
/// \file
/// Pixels that one sample has made far brighter than all around, as a path does that finds a lamp
/// by chance.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/noisy_picture.h"

namespace freqsynth::detail {

/// Finds lone peaks of one channel.
class LonePeaks {
 public:
  LonePeaks(const NoisyPicture& picture, std::size_t channel)
      : picture_(picture),
        sums_(picture.sums[channel]),
        pixels_(picture.pixels[channel]),
        blocks_x_(picture.width / block_size),
        squares_(picture.variances[channel].begin(), picture.variances[channel].end()) {
    std::vector<double> samples(squares_.size());
    for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
      samples[block_of(pixel)] += static_cast<double>(picture.weights[pixel]);
    }
    for (std::size_t block = 0; block < samples.size(); ++block) squares_[block] *= samples[block];
  }

  /// The pixels without their lone peaks. A pixel is one when hardly any of those 2 or 3 away is as
  /// bright, and what its samples have too much could be that of one: then its square is not much
  /// more than all that the block's fit leaves over. Where many samples agree, each has a small
  /// part of it, so that small lamps stay.
  [[nodiscard]] NoisyPicture::Plane removed(const ExecutorRef& executor = {}) const {
    NoisyPicture::Plane result = pixels_;
    share_pieces(executor, picture_.height / block_size, [&](std::size_t row) {
      std::vector<std::int32_t> brighter(picture_.width);
      for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
        count_brighter(y, brighter);
        for (std::size_t x = 0; x < picture_.width; ++x) {
          if (brighter[x] >= std::int32_t{most_as_bright}) continue;
          const float most = usual_around(x, y);
          if (is_of_one_sample(x, y, most)) result[y * picture_.width + x] = most;
        }
      }
    });
    return result;
  }

 private:
  static constexpr std::size_t near = 1, far = 3, most_as_bright = 3;

  [[nodiscard]] std::size_t block_of(std::size_t pixel) const {
    return pixel / picture_.width / block_size * blocks_x_ + pixel % picture_.width / block_size;
  }
  /// Calls visit(u, v) for pixels up to `reach` away.
  template <class Visit>
  void visit_around(std::size_t x, std::size_t y, std::size_t reach, const Visit& visit) const {
    for (std::size_t v = y - std::min(y, reach); v < std::min(y + reach + 1, picture_.height);
         ++v) {
      for (std::size_t u = x - std::min(x, reach); u < std::min(x + reach + 1, picture_.width);
           ++u) {
        visit(u, v);
      }
    }
  }
  /// Of each pixel of a line, how many of those 2 or 3 away are as bright: pixel by pixel for one
  /// neighbour after the other, which compilers make vectors of.
  void count_brighter(std::size_t y, std::span<std::int32_t> counts) const {
    const std::size_t width = picture_.width;
    std::fill(counts.begin(), counts.end(), 0);
    const float* const own = &pixels_[y * width];
    for (std::size_t v = y - std::min(y, far); v < std::min(y + far + 1, picture_.height); ++v) {
      const float* const line = &pixels_[v * width];
      const bool all_far = v + near < y || v > y + near;
      for (std::size_t shift = all_far ? 0 : near + 1; shift <= std::min(far, width - 1); ++shift) {
        for (std::size_t x = shift; x < width; ++x) counts[x] += line[x - shift] >= own[x] ? 1 : 0;
        if (shift == 0) continue;
        for (std::size_t x = shift; x < width; ++x) {
          counts[x - shift] += line[x] >= own[x - shift] ? 1 : 0;
        }
      }
    }
  }
  /// The third of the brightest pixels that are 2 or 3 away.
  [[nodiscard]] float usual_around(std::size_t x, std::size_t y) const {
    std::array<float, most_as_bright> most;
    most.fill(-std::numeric_limits<float>::infinity());
    visit_around(x, y, far, [&](std::size_t u, std::size_t v) {
      if (u + near >= x && u <= x + near && v + near >= y && v <= y + near) return;
      float value = pixels_[v * picture_.width + u];
      for (float& other : most) {
        if (value > other) std::swap(value, other);
      }
    });
    return most.back();
  }
  [[nodiscard]] bool is_of_one_sample(std::size_t x, std::size_t y, float most) const {
    constexpr double share = 0.5;  // of the square of what is too much
    double excess = 0;
    visit_around(x, y, near, [&](std::size_t u, std::size_t v) {
      const std::size_t pixel = v * picture_.width + u;
      const double usual = static_cast<double>(picture_.weights[pixel]) * static_cast<double>(most);
      excess += std::max(0.0, static_cast<double>(sums_[pixel]) - usual);
    });
    return squares_[block_of(y * picture_.width + x)] > share * excess * excess;
  }

  const NoisyPicture& picture_;
  const NoisyPicture::Plane& sums_;
  const NoisyPicture::Plane& pixels_;
  std::size_t blocks_x_;
  std::vector<double> squares_;  // of each block: the sum of what its fit leaves over, squared
};

}  // namespace freqsynth::detail
