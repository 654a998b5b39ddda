// SPDX-License-Identifier: MIT
#include "window.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quality {

Window busiest_window(const PictureView& picture, std::size_t side) {
  const std::size_t width = picture.width;
  const std::size_t height = picture.height;
  const auto value = [&](std::size_t x, std::size_t y, std::size_t c) {
    const double linear = double{picture.pixels[3 * (y * width + x) + c]};
    return std::sqrt(std::clamp(linear, 0.0, 1.0));
  };
  // sums[y][x]: over all pixels above and to the left of (x, y).
  std::vector<double> sums((width + 1) * (height + 1));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      double detail = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        if (x != 0) detail += std::abs(value(x, y, c) - value(x - 1, y, c));
        if (y != 0) detail += std::abs(value(x, y, c) - value(x, y - 1, c));
      }
      sums[(y + 1) * (width + 1) + x + 1] = detail + sums[(y + 1) * (width + 1) + x] +
                                            sums[y * (width + 1) + x + 1] -
                                            sums[y * (width + 1) + x];
    }
  }
  Window best{0, 0, std::min(side, width), std::min(side, height)};
  double most = -1;
  for (std::size_t y = 0; y + best.height <= height; y += 8) {
    for (std::size_t x = 0; x + best.width <= width; x += 8) {
      const std::size_t right = x + best.width;
      const std::size_t below = (y + best.height) * (width + 1);
      const double detail = sums[below + right] - sums[below + x] - sums[y * (width + 1) + right] +
                            sums[y * (width + 1) + x];
      if (detail <= most) continue;
      most = detail;
      best.x = x;
      best.y = y;
    }
  }
  return best;
}

}  // namespace quality
