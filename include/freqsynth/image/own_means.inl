// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/image/own_means.h"

namespace freqsynth {

FREQSYNTH_INLINE OwnMeans::OwnMeans(const BlocksMeans& blocks) {
  constexpr std::size_t last = block_size - 1;
  values_.fill(unknown);
  for (std::size_t row = 0; row < side; ++row) {
    const std::size_t line = row == 0 ? 0 : row < side - 1 ? 3 : 6;
    const std::size_t first = block_size * (row == 0 ? last : row < side - 1 ? row - 1 : 0);
    if (blocks[line]) at(0, row) = blocks[line][first + last];
    if (blocks[line + 1]) std::copy_n(blocks[line + 1] + first, block_size, &at(1, row));
    if (blocks[line + 2]) at(side - 1, row) = blocks[line + 2][first];
  }
}

FREQSYNTH_INLINE void OwnMeans::hold(std::span<float, max_terms> pixels, float range,
                                     float ringing) const {
  // Flat beside an edge of that range: so that smooth slopes, which samples alone would make
  // coarse, are not.
  const float alike = 7e-4f * range;
  static_assert(unknown == detail::PaddedBlock::none);
  detail::AlignedBlock held;
  std::copy(pixels.begin(), pixels.end(), held.begin());
  detail::hold_flat(values_.data(), side, alike, ringing * range, held.data());
  std::copy(held.begin(), held.end(), pixels.begin());
}

}  // namespace freqsynth
