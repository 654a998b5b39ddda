// SPDX-License-Identifier: MIT
/// \file
/// What is left of Monte Carlo noise, smoothed over the whole picture.
///
/// Twice the samples are regressed (GuidedRegression) on the finished pixels: first on those of the
/// blocks' own fits, which know edges that nothing else tells, together with features; then on the
/// result. These guides are made of the same samples, so their noise agrees with the samples'.
/// Hence ridges in proportion to the variance that the noise of a pixel's mean has, and peaks that
/// one sample has made are no guides (LonePeaks). The light of rare samples is left out of all that
/// and handed out at the end (RareLight). In between, steps that noise leaves on borders of
/// blocks are taken back, and so are differences between blocks that are noise alone. Each pass
/// stays within the range of the pixels that it began with, 5 x 5 around each.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/image/noisy_picture.h"

namespace freqsynth {

/// Smooths channels of a picture.
/// \param picture   pixels of `channels` are replaced; those of `features` that are not `seamless`
///                  lose steps on the borders of blocks
/// \param channels  those that have noise
/// \param features  those that guide the others, and are to have less noise. The time grows with
///                  the square of their number.
/// \throws std::invalid_argument when a plane has not the size of the picture, there are not as
///         many planes of sums and variances as of pixels, or a channel does not exist.
FREQSYNTH_API void smooth_noise(NoisyPicture& picture, std::span<const std::size_t> channels,
                                std::span<const std::size_t> features);

namespace detail {
FREQSYNTH_API void smooth_noise_on(NoisyPicture& picture, std::span<const std::size_t> channels,
                                   std::span<const std::size_t> features,
                                   const ExecutorRef& executor);
}  // namespace detail

/// The same on an executor's threads; the result does not depend on it.
/// \throws what the executor throws, too; the picture is of no use then.
template <class E>
requires Executor<std::remove_reference_t<E>>
void smooth_noise(NoisyPicture& picture, std::span<const std::size_t> channels,
                  std::span<const std::size_t> features, E&& executor) {
  detail::smooth_noise_on(picture, channels, features, detail::ExecutorRef(executor));
}

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/smooth_noise.inl"
#endif
