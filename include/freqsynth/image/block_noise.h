// SPDX-License-Identifier: MIT
/// \file
/// What noise does to blocks as wholes: their levels differ, and steps show on their borders. Both
/// are judged by the noise that the samples of a block show, and taken back where noise explains
/// them.
#pragma once

#include <cstddef>
#include <span>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/image/noisy_picture.h"

namespace freqsynth {
namespace detail {

/// Takes steps across the borders of blocks back. A step, extrapolated from the two pixels on
/// either side and averaged along the border, counts s^2 / (s^2 + v); what is left of it is spread
/// over the four pixels on each side.
/// \param pixels    of one channel, changed in place
/// \param sums      of the channel's samples in each pixel
/// \param variance  v, in units of the variance of a pixel's mean
FREQSYNTH_API void close_borders(const NoisyPicture& picture, std::span<const float> sums,
                                 double variance, std::span<float> pixels,
                                 const ExecutorRef& executor = {});

/// Draws the levels of blocks to that of all samples around where most of their differences is what
/// the noise that is usual there would make of them. A block that was sampled until it had seen
/// light, or was left because it had seen none, has a level that is biased; the sum of all samples
/// around over their number is not (Wald). Where blocks do differ that is the mean of those with
/// many samples, so nothing is drawn to it.
/// \param pixels    of one channel, changed in place
/// \param sums      of the channel's samples in each pixel
/// \param all_sums  the same with light that is added later; it is noise as well
FREQSYNTH_API void pool_levels(const NoisyPicture& picture, std::span<const float> sums,
                               std::span<const float> all_sums, std::span<float> pixels,
                               const ExecutorRef& executor = {});

}  // namespace detail
}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/block_noise.inl"
#endif
