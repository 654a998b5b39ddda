// SPDX-License-Identifier: MIT
/// \file
/// Linear interpolation between the centres of cells.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// The two cells along an axis whose centres are nearest to a pixel's, and the second one's share.
template <class Real>
struct LinearBlend {
  std::size_t first, second;
  Real share;
};

/// Of all pixels along an axis. Before the first centre the first cell counts alone; beyond the
/// last one both are the last cell.
/// \param cell   pixels of a cell
/// \param cells  how many, at least one
/// \param last   the greatest place in cells, from the first one's centre: where shares end
template <class Real>
std::vector<LinearBlend<Real>> blends_along(std::size_t pixels, std::size_t cell, std::size_t cells,
                                            Real last) {
  std::vector<LinearBlend<Real>> blends(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const Real place = (static_cast<Real>(pixel) + Real(0.5)) / static_cast<Real>(cell) - Real(0.5);
    const Real held = std::clamp(place, Real(0), last);
    const auto first = static_cast<std::size_t>(held);
    blends[pixel] = {first, std::min(first + 1, cells - 1), held - static_cast<Real>(first)};
  }
  return blends;
}

/// The value at a pixel of what is known at the centres of cells, row by row.
template <class Real>
Real blended(const Real* cells, std::size_t cells_x, const LinearBlend<Real>& column,
             const LinearBlend<Real>& row) {
  const Real* above = cells + row.first * cells_x;
  const Real* below = cells + row.second * cells_x;
  const Real right = column.share, down = row.share;
  return (1 - down) * ((1 - right) * above[column.first] + right * above[column.second]) +
         down * ((1 - right) * below[column.first] + right * below[column.second]);
}

}  // namespace freqsynth::detail
