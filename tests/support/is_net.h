// SPDX-License-Identifier: MIT
/// \file
/// How evenly points are spread, by the definition.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <span>

namespace helpers {

/// Whether each of the rectangles of area 2^-m whose sides are powers of two holds one of the 2^m
/// points: what a (0, m, 2)-net is.
inline bool is_net(std::span<const std::array<std::uint32_t, 2>> points, unsigned m) {
  for (unsigned across = 0; across <= m; ++across) {
    std::set<std::uint64_t> cells;
    for (const auto& [x, y] : points) {
      // Not shifts by all 32 bits, which have no meaning.
      const std::uint64_t column = std::uint64_t{x} >> (32 - across);
      const std::uint64_t row = std::uint64_t{y} >> (32 - (m - across));
      cells.insert((column << 32) | row);
    }
    if (cells.size() != points.size()) return false;
  }
  return true;
}

}  // namespace helpers
