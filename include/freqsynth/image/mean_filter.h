// SPDX-License-Identifier: MIT
/// \file
/// Filters wider than a pixel for pictures of which only the pixels' averages are known.
#pragma once

#include <cstddef>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/filter_kernel.h"
#include "freqsynth/image/pixel_view.h"

namespace freqsynth::detail {

/// What each pixel of a line of averages is worth in each pixel of an output of another size.
struct MeanAxis {
  /// Of a pixel of the output.
  struct Reach {
    std::size_t first, count;              ///< averages that have weights
    std::size_t range_first, range_count;  ///< those whose range it stays within
  };

  std::size_t stride = 0;  ///< of `weights`: the longest count, rounded up to 8
  std::vector<Reach> pixels;
  std::vector<float> weights;  ///< [pixel][stride], 0 beyond its count
};

/// One axis: `size` averages become `out` filtered pixels. The averages are those of a natural
/// histospline, which is filtered exactly; weights below 1e-8 are left out.
[[nodiscard]] MeanAxis make_mean_axis(std::size_t size, std::size_t out,
                                      const FilterKernel& kernel);

/// Filters `width` x `height` averages, row by row, into channel 0 of `out`.
/// \param bounded  hold pixels in the range of the averages around them
void filter_means(const float* means, std::size_t width, const MeanAxis& columns,
                  const MeanAxis& rows, bool bounded, const PixelView& out);

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/mean_filter.inl"
#endif
