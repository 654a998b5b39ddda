// SPDX-License-Identifier: MIT
/// \file
/// Images of a store of blocks: what the refiner says of each, as it is and finished.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {
namespace detail {

/// Coefficients in units of 2 to the power of an exponent, in -126..126, in the host's unit.
inline void to_host_unit(std::span<float> coefficients, int exponent) {
  const float unit = std::ldexp(1.0f, exponent);
  for (float& coefficient : coefficients) coefficient *= unit;
}

}  // namespace detail

/// The fit itself (CoefficientMeaning::point_function).
template <Refiner R>
[[nodiscard]] FrequencyImage fit_image(const BlockGrid& grid, const BlockStore<R>& blocks) {
  const std::size_t channels = blocks.refiner().channels();
  FrequencyImage image(grid.width, grid.height, channels);
  std::vector<Gap> gaps;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t x = grid.column(b);
    const std::size_t y = grid.row(b);
    image.samples(x, y) = blocks.samples(b);
    for (std::size_t c = 0; c < channels; ++c) {
      const auto coefficients = image.coefficients(x, y, c);
      const BlockFit fit = blocks.fit_without_gaps(b, c, gaps);
      std::copy(fit.coefficients.begin(), fit.coefficients.end(), coefficients.begin());
      detail::to_host_unit(coefficients, blocks.exponent(c));
    }
  }
  return image;
}

/// Finished pixels (CoefficientMeaning::pixel_average).
/// \param list  the one that the blocks were refined with
/// \throws std::invalid_argument when a setting is out of range.
template <Refiner R>
[[nodiscard]] FrequencyImage finished_image(const BlockGrid& grid, const BlockStore<R>& blocks,
                                            const SharedInverseList& list,
                                            const FinishSettings& settings) {
  const std::size_t channels = blocks.refiner().channels();
  FrequencyImage image(grid.width, grid.height, channels, CoefficientMeaning::pixel_average);
  PixelFinisher finisher(list, settings);
  std::vector<Gap> gaps;
  std::vector<std::uint32_t> order(blocks.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return blocks.samples(a) < blocks.samples(b);
  });
  for (const std::uint32_t block : order) {
    const std::size_t x = grid.column(block);
    const std::size_t y = grid.row(block);
    image.samples(x, y) = blocks.samples(block);
    finisher.advance(blocks.samples(block));
    for (std::size_t c = 0; c < channels; ++c) {
      finisher.finish(blocks.fit_without_gaps(block, c, gaps), image.coefficients(x, y, c));
      detail::to_host_unit(image.coefficients(x, y, c), blocks.exponent(c));
    }
  }
  return image;
}

}  // namespace freqsynth
