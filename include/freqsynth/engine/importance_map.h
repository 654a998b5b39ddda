// SPDX-License-Identifier: MIT
/// \file
/// Importance of blocks (SynthesisSettings::importance, Synthesizer::set_importance()) from a
/// function of the position, or from an image of any size.
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// What blocks are worth, row by row, when `importance(x, y)` is what points are worth: its mean
/// over the centres of the block's pixels.
/// \param width       pixels of the picture
/// \param height      pixels of the picture
/// \param importance  of a position in pixels, a number. The importance of a block has to be 0 or
///                    in 1e-6..1e6.
/// \throws std::invalid_argument when there would be too many blocks.
template <std::invocable<double, double> F>
[[nodiscard]] std::vector<float> importance_map(std::size_t width, std::size_t height,
                                                F&& importance) {
  const BlockGrid grid = BlockGrid::of(width, height, 1);
  std::vector<float> map;
  map.reserve(grid.size());
  for (std::size_t block = 0; block < grid.size(); ++block) {
    const std::size_t left = grid.column(block) * block_size, top = grid.row(block) * block_size;
    const std::size_t right = left + grid.block_width(block);
    const std::size_t bottom = top + grid.block_height(block);
    double sum = 0;
    for (std::size_t y = top; y < bottom; ++y) {
      for (std::size_t x = left; x < right; ++x) {
        sum += static_cast<double>(
            importance(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
      }
    }
    map.push_back(static_cast<float>(sum / static_cast<double>((right - left) * (bottom - top))));
  }
  return map;
}

/// The same of an image that is laid over the picture and may be smaller or larger: its mean over
/// each block.
/// \param width       pixels of the picture
/// \param height      pixels of the picture
/// \param pixels      of the image, row by row
/// \param map_width   pixels of the image in a row, at least 1
/// \param map_height  pixels of the image in a column, at least 1
/// \throws std::invalid_argument when the image has not so many pixels or none, or there would be
///         too many blocks.
[[nodiscard]] FREQSYNTH_API std::vector<float> importance_map(std::size_t width, std::size_t height,
                                                              std::span<const float> pixels,
                                                              std::size_t map_width,
                                                              std::size_t map_height);

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/engine/importance_map.inl"
#endif
