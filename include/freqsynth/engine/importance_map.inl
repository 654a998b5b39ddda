// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/engine/importance_map.h"

namespace freqsynth {
namespace detail {

/// Calls visit(i, length) for each of `cells` equal cells of an axis from 0 to `pixels` that has
/// some of [begin, end], with how much.
template <class Visit>
void visit_cells(double begin, double end, double pixels, std::size_t cells, Visit&& visit) {
  const double per_pixel = static_cast<double>(cells) / pixels;
  const double low = begin * per_pixel;
  const double high = std::min(end * per_pixel, static_cast<double>(cells));
  for (auto i = static_cast<std::size_t>(low); i < cells && static_cast<double>(i) < high; ++i) {
    const auto at = static_cast<double>(i);
    visit(i, std::min(high, at + 1) - std::max(low, at));
  }
}

}  // namespace detail

FREQSYNTH_INLINE std::vector<float> importance_map(std::size_t width, std::size_t height,
                                                   std::span<const float> pixels,
                                                   std::size_t map_width, std::size_t map_height) {
  if (map_width == 0 || map_height == 0 || pixels.size() / map_width != map_height ||
      pixels.size() % map_width != 0) {
    detail::refuse("an importance map of " + std::to_string(map_width) + " x " +
                   std::to_string(map_height) + " has " + std::to_string(pixels.size()) +
                   " pixels");
  }
  const BlockGrid grid = BlockGrid::of(width, height, 1);
  std::vector<float> map;
  map.reserve(grid.size());
  for (std::size_t block = 0; block < grid.size(); ++block) {
    const auto left = static_cast<double>(grid.column(block) * block_size);
    const auto top = static_cast<double>(grid.row(block) * block_size);
    const double right = left + static_cast<double>(grid.block_width(block));
    const double bottom = top + static_cast<double>(grid.block_height(block));
    double sum = 0, area = 0;
    detail::visit_cells(
        top, bottom, static_cast<double>(height), map_height, [&](std::size_t y, double down) {
          detail::visit_cells(left, right, static_cast<double>(width), map_width,
                              [&](std::size_t x, double across) {
                                sum += down * across * double{pixels[y * map_width + x]};
                                area += down * across;
                              });
        });
    map.push_back(static_cast<float>(sum / area));
  }
  return map;
}

}  // namespace freqsynth
