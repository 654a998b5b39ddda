// SPDX-License-Identifier: MIT
#include "fxaa.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "supersampling.h"

namespace baselines {
namespace {

struct Step {
  std::ptrdiff_t x, y;
};

class Filter {
 public:
  Filter(const Rendering& picture, const FxaaSettings& settings)
      : picture_(picture), settings_(settings) {
    luma_.reserve(picture.width * picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
      const auto display = [&](std::size_t c) {
        return std::clamp(picture.pixels[i + c], 0.0f, 1.0f);
      };
      luma_.push_back(
          std::sqrt(0.2126f * display(0) + 0.7152f * display(1) + 0.0722f * display(2)));
    }
  }

  /// What of which neighbour is mixed into a pixel.
  struct Mix {
    float share;
    std::size_t neighbour;
  };

  [[nodiscard]] Mix mix(std::ptrdiff_t x, std::ptrdiff_t y) const {
    const auto at = [&](std::ptrdiff_t dx, std::ptrdiff_t dy) { return luma(x + dx, y + dy); };
    const float middle = at(0, 0);
    const float up = at(0, -1), down = at(0, 1), left = at(-1, 0), right = at(1, 0);
    const float highest = std::max({middle, up, down, left, right});
    const float range = highest - std::min({middle, up, down, left, right});
    if (range < std::max(settings_.edge_threshold_min, highest * settings_.edge_threshold)) {
      return {0, 0};
    }
    const float up_left = at(-1, -1), up_right = at(1, -1);
    const float down_left = at(-1, 1), down_right = at(1, 1);

    const float around =
        (2 * (up + down + left + right) + (up_left + up_right + down_left + down_right)) / 12;
    const float lone = std::clamp(std::abs(around - middle) / range, 0.0f, 1.0f);
    const float smooth = lone * lone * (3 - 2 * lone);
    const float subpixel = smooth * smooth * settings_.subpixel;

    const float across = std::abs(up_left - 2 * left + down_left) +
                         2 * std::abs(up - 2 * middle + down) +
                         std::abs(up_right - 2 * right + down_right);
    const float along = std::abs(down_left - 2 * down + down_right) +
                        2 * std::abs(left - 2 * middle + right) +
                        std::abs(up_left - 2 * up + up_right);
    const bool horizontal = across >= along;
    const float before = horizontal ? up : left;
    const float after = horizontal ? down : right;
    const bool is_before = std::abs(before - middle) >= std::abs(after - middle);
    const std::ptrdiff_t sign = is_before ? -1 : 1;
    const Step beyond = horizontal ? Step{0, sign} : Step{sign, 0};
    const Step forth = horizontal ? Step{1, 0} : Step{0, 1};

    const float share =
        std::max(covered(x, y, beyond, forth, is_before ? before : after), subpixel);
    return {share, index(x + beyond.x, y + beyond.y)};
  }

 private:
  [[nodiscard]] std::size_t index(std::ptrdiff_t x, std::ptrdiff_t y) const {
    const auto last_x = static_cast<std::ptrdiff_t>(picture_.width) - 1;
    const auto last_y = static_cast<std::ptrdiff_t>(picture_.height) - 1;
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(y, 0, last_y)) * picture_.width +
           static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(x, 0, last_x));
  }
  [[nodiscard]] float luma(std::ptrdiff_t x, std::ptrdiff_t y) const { return luma_[index(x, y)]; }

  struct End {
    float distance;
    float luma;  // relative to the mean of the edge's two sides
  };

  /// The share of the neighbour beyond the edge by the position on the edge.
  [[nodiscard]] float covered(std::ptrdiff_t x, std::ptrdiff_t y, Step beyond, Step forth,
                              float neighbour) const {
    const float middle = luma(x, y);
    const float mean = 0.5f * (middle + neighbour);
    const float enough = 0.25f * std::abs(neighbour - middle);
    const auto end = [&](std::ptrdiff_t sign) {
      End found{};
      for (std::size_t i = 1; i <= settings_.search; ++i) {
        const std::ptrdiff_t distance = sign * static_cast<std::ptrdiff_t>(i);
        const std::ptrdiff_t along_x = x + distance * forth.x;
        const std::ptrdiff_t along_y = y + distance * forth.y;
        found.distance = static_cast<float>(i);
        found.luma =
            0.5f * (luma(along_x, along_y) + luma(along_x + beyond.x, along_y + beyond.y)) - mean;
        if (std::abs(found.luma) >= enough) break;
      }
      return found;
    };
    const End back = end(-1);
    const End front = end(1);
    const End& nearer = back.distance < front.distance ? back : front;
    // The edge turns towards the other side there: nothing of the neighbour is in this pixel.
    if ((nearer.luma < 0) == (middle - mean < 0)) return 0;
    return 0.5f - nearer.distance / (back.distance + front.distance);
  }

  const Rendering& picture_;
  const FxaaSettings& settings_;
  std::vector<float> luma_;
};

}  // namespace

Rendering fxaa_filtered(const Rendering& picture, const FxaaSettings& settings) {
  Rendering filtered = picture;
  const Filter filter(picture, settings);
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const auto [share, neighbour] =
          filter.mix(static_cast<std::ptrdiff_t>(x), static_cast<std::ptrdiff_t>(y));
      if (share == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        filtered.pixels[(y * picture.width + x) * 3 + c] +=
            share *
            (picture.pixels[neighbour * 3 + c] - picture.pixels[(y * picture.width + x) * 3 + c]);
      }
    }
  }
  return filtered;
}

Rendering fxaa(const Radiance& radiance, const Job& job, const FxaaSettings& settings) {
  return fxaa_filtered(supersampling(radiance, job, {.jittered = false}), settings);
}

}  // namespace baselines
