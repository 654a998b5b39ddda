// SPDX-License-Identifier: MIT
/// \file
/// The priority metric (paper, section 4.4): how much a block deserves the next sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Highest priority of a block that has a sample. One without is more urgent than any of them.
inline constexpr float most_priority = std::numeric_limits<float>::max() / 2;

/// How the worth of a block's next sample is estimated.
enum class PriorityMeasure : std::uint8_t {
  residual,  ///< from the residuals of all samples so far, of the block and of those around it
  change     ///< the paper's: from what the last samples have changed
};

/// In what unit the errors of blocks are compared.
enum class Steer : std::uint8_t {
  linear,    ///< that of the signal
  relative,  ///< relative to what a block shows: all parts of a picture count the same, whatever
             ///< their brightness, but those that are 64 times darker than its median, or more
  display    ///< as a display in sRGB shows them: linear light, clamped to 0..1 and encoded
};

/// With PriorityMeasure::change, p_n = (1 - w) p_{n-1} + w (U r^n + V_n), where V_n is the mean
/// squared change of the block's pixels caused by its n-th sample and U r^n the uncertainty of a
/// block that has had few samples.
///
/// With PriorityMeasure::residual, p_n = (R + U r^n / n) 64 / n * (1 - (a / b)^1.5) / (b - a). The
/// first part is the squared error that least squares expects of 64 terms after n samples whose
/// residuals have the variance R, one more of U r^n among them. R is that of the block, pooled with
/// the blocks beside it and with the whole image: a regular pattern may look flat on the first
/// samples of a whole block, but its neighbours know better. The second part is the share of the
/// error that a sample takes away. a and b are the numbers of samples, a <= n < b, at which the
/// positions of the sequence are even; see SampleSequence::even_size(). Measured on many functions
/// the error falls from one even lattice to the next with the power 1.5 of their sizes. In between
/// positions are uneven: a texture may be 1.4 times as wrong after 77 samples as after 79 or 81. So
/// the worth of a sample drops where a step ends: a block that has begun one ends it, unless
/// another one has a much larger error, and blocks that are about alike get equal samples. Of
/// blocks narrower than 8 pixels p_n counts by the root of the area, beside their factor: they have
/// fewer pixels to tell apart, but are as long.
///
/// All of these are squares of the signal where Steer::linear is set. Otherwise R, V and the
/// image's variance are those of the signal as it is seen: as ln(v) for large v, or encoded. With
/// PriorityMeasure::residual blocks that have had more than a sample per pixel then also count by
/// its inverse, unless the sampler is noisy.
struct PrioritySettings {
  /// w, weight of the newest estimate, in (0, 1].
  double weight = 0.3;
  /// U in units of the image's own variance, in 0..1e6, so that the signal's scale does not matter.
  double uncertainty = 1.0;
  /// r, decay of the uncertainty per sample, in [0, 1).
  double decay = 0.7165;
  /// Which of the two formulas it is.
  PriorityMeasure measure = PriorityMeasure::residual;
  /// How many samples of the block's own the mean residuals of the blocks beside it count for, in
  /// 0..1e6.
  double neighbours = 16;
  /// The same for the mean residuals of all blocks, so that no block is ever taken for flat.
  double image = 1;
  /// No block (with RefinerKind::kriging, no leaf of the tree, by its area) stays behind the others
  /// for good, however flat it looks: when the blocks have m samples on average, those with fewer
  /// than m^exploration come first. In [0, 1]; 0: never, 1: all blocks get the same number of
  /// samples.
  double exploration = 0.82;
  /// In what unit errors count. For hosts that give linear light and show it encoded: to a linear
  /// measure, dark parts are good enough when what is seen of them is not. Not with a quantization
  /// target, which has a unit of its own.
  Steer steer = Steer::linear;
  /// What a value is multiplied by before it is shown, for Steer::display. In 1e-30..1e30.
  double exposure = 1;

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate() const;
};

/// The metric as a running value per block: the part that depends on the samples' values
/// (variation) is kept by the caller, the part that depends on their number alone is tabulated
/// here.
class FREQSYNTH_API PriorityMetric {
 public:
  /// \param max_samples  most samples that a block can get
  PriorityMetric(const PrioritySettings& settings, std::size_t max_samples);

  /// Variation after one more sample that changed the block by `change`; starts at 0.
  [[nodiscard]] float variation(float before, float change) const {
    return before + weight_ * (change - before);
  }

  /// Priority of a block after `samples` (at least 1) samples, in squared units of the signal.
  /// This one is the paper's.
  /// \param variance  variance of the image
  [[nodiscard]] float priority(float variation, std::size_t samples, float variance) const {
    return variation + uncertainty(samples, variance);
  }

  /// Squared error that a block's next sample is expected to take away, from the variance of its
  /// residuals after `samples` (at least 1) samples, as a mean over its pixels.
  /// \param variance  variance of the image
  [[nodiscard]] float expected_gain(float residual, std::size_t samples, float variance) const {
    FREQSYNTH_ASSERT(samples < gains_.size());
    return (residual + variance * doubts_[samples]) * gains_[samples] + variance * floor(samples);
  }

  /// The running average of U r^n for an image of that variance.
  [[nodiscard]] float uncertainty(std::size_t samples, float variance) const {
    FREQSYNTH_ASSERT(samples < uncertainty_.size());
    return variance * uncertainty_[samples];
  }

 private:
  /// Keeps blocks that never changed in order: the one with the fewest samples comes first.
  static float floor(std::size_t samples) { return 1e-12f / (static_cast<float>(samples) + 1); }

  float weight_;
  std::vector<float> doubts_;       // U r^n / n after n samples
  std::vector<float> gains_;        // of a sample, for residuals of 1
  std::vector<float> uncertainty_;  // the running average of U r^n after n samples
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/engine/priority.inl"
#endif
