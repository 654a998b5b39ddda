// SPDX-License-Identifier: MIT
/// \file
/// Non-local means with the variance of pixels, in two halves.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "pixel_buffers.h"

namespace baselines {

struct NonLocalMeansSettings {
  std::size_t search = 8;  ///< pixels up to this far away count, in x and y
  std::size_t patch = 3;   ///< half the side of the patches that are compared
  double k = 0.45;         ///< how many deviations two pixels may differ
};

/// Visits all offsets from a pixel to others, with a weight for each pixel: how alike the patches
/// about it and about the other are, in 0..1; 0 where the other is outside.
/// \param guide     the picture whose patches are compared, over all channels
/// \param variance  of its values
void for_each_weight(const Buffer& guide, const Buffer& variance,
                     const NonLocalMeansSettings& settings,
                     const std::function<void(std::ptrdiff_t dx, std::ptrdiff_t dy,
                                              std::span<const float> weights)>& visit);

/// The weighted mean of the pixels of `source`.
[[nodiscard]] Buffer filtered(const Buffer& source, const Buffer& guide, const Buffer& variance,
                              const NonLocalMeansSettings& settings);

/// The mean of both halves, each filtered with the weights of the other, whose noise is not its
/// own.
[[nodiscard]] Buffer cross_filtered(const PixelBuffers& buffers,
                                    const NonLocalMeansSettings& settings);

/// The pixels of Owen-scrambled Sobol points, by non-local means (Rousselle, Knaus and Zwicker,
/// Adaptive Rendering with Non-Local Means Filtering, 2012), without its choice where to sample.
/// Below one sample per pixel it is sobol_box(). Takes exactly the samples allowed.
[[nodiscard]] Rendering non_local_means(const Radiance& radiance, const Job& job,
                                        const NonLocalMeansSettings& settings = {});

}  // namespace baselines
