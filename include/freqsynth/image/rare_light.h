// SPDX-License-Identifier: MIT
/// \file
/// Light that few samples have, each far more of it than all around: that of paths which find a
/// lamp by chance.
///
/// Blocks that have met such a sample get more samples, and those that have met none do not. So by
/// the means of blocks there is too little of it nearly everywhere, however many samples there are.
/// The sum of all samples over their number is not biased by that (Wald's equation). Hence it is
/// taken out of the samples before noise is smoothed, and handed out by the number of samples
/// afterwards, far enough around.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/image/noisy_picture.h"

namespace freqsynth {
namespace detail {

/// That of one channel.
class FREQSYNTH_API RareLight {
 public:
  /// Finds it: at lone peaks (LonePeaks), what is above them in a pixel's samples, if that is far
  /// more than noise and light usually are around, and hardly any of the pixels around has as much.
  RareLight(const NoisyPicture& picture, std::size_t channel, const ExecutorRef& executor = {});

  /// Whether there is any.
  [[nodiscard]] bool any() const;

  /// The sums of the samples of each pixel without it.
  [[nodiscard]] NoisyPicture::Plane other_sums() const;

  /// Adds it to pixels: each of its samples to the blocks around, the less the farther, and in
  /// proportion to how bright pixels are, up to what is usual around. The pixels' sum by their
  /// numbers of samples grows by what other_sums() lack.
  void spread(std::span<float> pixels, const ExecutorRef& executor = {}) const;

 private:
  void find(std::size_t row, std::span<const float> without_peaks,
            std::span<const double> variances, std::span<const double> levels);
  [[nodiscard]] std::vector<double> spread_around(std::vector<double> values) const;
  [[nodiscard]] std::vector<double> usual_levels(std::span<const float> pixels,
                                                 const ExecutorRef& executor) const;

  const NoisyPicture& picture_;
  std::size_t channel_, blocks_x_, blocks_y_;
  NoisyPicture::Plane light_;  // of each pixel: the sum over its samples
};

}  // namespace detail
}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/rare_light.inl"
#endif
