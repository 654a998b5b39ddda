// SPDX-License-Identifier: MIT
/// \file
/// How a picture is cut into windows, and what may be spent on each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/frequency_image.h"

namespace farm {

/// A window, and what may be spent on it.
struct WindowTask {
  static constexpr std::uint64_t no_limit = ~std::uint64_t{0};

  freqsynth::PixelWindow window;
  std::uint64_t samples;  ///< most of them
};

/// Cuts a picture into columns x rows windows of about the same size, between blocks. Fewer where
/// there are not as many blocks.
[[nodiscard]] std::vector<freqsynth::PixelWindow> cut_windows(std::size_t width, std::size_t height,
                                                              std::size_t columns,
                                                              std::size_t rows);

/// Pixels of a picture that are one of a coarse picture of it, in width and in height.
[[nodiscard]] std::size_t coarse_step(std::size_t width, std::size_t height);

/// Shares samples out among windows as a coarse picture of the whole took its own. What lies around
/// a window, which is sampled for its borders' sake, counts as part of it.
/// \param step  see coarse_step()
[[nodiscard]] std::vector<WindowTask> share_out(std::span<const freqsynth::PixelWindow> windows,
                                                const freqsynth::FrequencyImage& coarse,
                                                std::size_t step, std::uint64_t samples);

}  // namespace farm
