// SPDX-License-Identifier: MIT
/// \file
/// What a measure of blocks looks at.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/signal_statistics.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// What a measure may look at.
template <Refiner R>
struct BlockView {
  const BlockGrid& grid;           ///< where blocks lie
  const BlockStore<R>& blocks;     ///< what is known of each
  const SignalStatistics& signal;  ///< the scale of the signal
};

/// The residual of a block, weighted over the channels, but no more than the signal's range allows:
/// a stray value must not speak louder than all others.
template <Refiner R>
[[nodiscard]] float plausible_residual(const BlockView<R>& view, std::uint32_t block) {
  // The residuals of least squares have at most the sum of squares of the values themselves.
  const float most = view.signal.most_variance(view.blocks.refiner().weights()) *
                     static_cast<float>(view.blocks.samples(block)) / view.blocks.freedom(block);
  return std::min(view.blocks.residual(block), most);
}

/// The same of one channel.
template <Refiner R>
[[nodiscard]] float plausible_residual(const BlockView<R>& view, std::uint32_t block,
                                       std::size_t channel) {
  const float most = view.signal.most_variance(channel) *
                     static_cast<float>(view.blocks.samples(block)) / view.blocks.freedom(block);
  return std::min(view.blocks.residual(block, channel), most);
}

}  // namespace freqsynth
