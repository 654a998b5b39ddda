// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>

#include "freqsynth/basis/kernels.h"
#include "freqsynth/image/own_means.h"

namespace freqsynth {

FREQSYNTH_INLINE OwnMeans::OwnMeans(const BlocksMeans& blocks) {
  constexpr std::size_t last = block_size - 1;
  const auto is_unknown = [](const float* block) { return block == nullptr; };
  if (std::any_of(blocks.begin(), blocks.end(), is_unknown)) values_.fill(unknown);
  // From the line of three blocks that begins with `line`, the row of pixels that is `down` in it.
  const auto set_row = [&](std::size_t row, std::size_t line, std::size_t down) {
    const std::size_t first = block_size * down;
    if (blocks[line]) at(0, row) = blocks[line][first + last];
    if (blocks[line + 1]) {
      std::memcpy(&at(1, row), blocks[line + 1] + first, block_size * sizeof(float));
    }
    if (blocks[line + 2]) at(side - 1, row) = blocks[line + 2][first];
  };
  set_row(0, 0, last);
  for (std::size_t y = 0; y < block_size; ++y) set_row(y + 1, 3, y);
  set_row(side - 1, 6, 0);
}

FREQSYNTH_INLINE void OwnMeans::hold(std::span<float, max_terms> pixels, float range,
                                     float ringing) const {
  // Flat beside an edge of that range: so that smooth slopes, which samples alone would make
  // coarse, are not.
  const float alike = 7e-4f * range;
  static_assert(unknown == detail::PaddedBlock::none);
  detail::hold_flat(values_.data(), side, alike, ringing * range, pixels.data());
}

}  // namespace freqsynth
