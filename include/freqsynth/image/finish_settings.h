// SPDX-License-Identifier: MIT
/// \file
/// How finished pixels are made.
#pragma once

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/noise.h"
#include "freqsynth/image/butterworth.h"

namespace freqsynth {

/// How pixels are made of a fit and its residuals.
struct FinishSettings {
  ButterworthSettings butterworth = {};  ///< the filter of the fit
  /// false: the paper's estimate, the mean of the filtered fit alone. The settings below are for
  /// true.
  bool residuals = true;
  /// Whether samples are Monte Carlo estimates. Synthesizer::finished_image() knows what
  /// `automatic` is; without a synthesis it is `none`.
  Noise noise = Noise::automatic;
  /// A pixel's residuals with a total weight of w samples count w / (w + doubt). Finite and >= 0.
  double doubt = 0.5;
  /// The same where there is noise.
  double noisy_doubt = 1;
  /// Where there is noise, the doubt is measured in each block that has a sample per pixel or more:
  /// variance of the residuals within pixels over that of the pixels' true means. It is right for
  /// independent samples; of a function without noise evenly spread samples tell more.
  bool measure_doubt = true;
  /// A coefficient F with an expected squared error of e counts max(0, 1 - shrinkage e / F^2).
  /// Finite and >= 0; 1 is the empirical Wiener filter.
  double shrinkage = 2;
  /// A pixel stays within the range of the means of the samples in it and in its 8 neighbours of
  /// the same block, widened on each side by this share of the distance between its end and the
  /// median; where fewer than 4 of them have samples, in the range of the whole block. Only in
  /// blocks whose residuals are over 1 percent of that range. >= 0; infinite: no bounds.
  double slack = 0.4;
  /// Where there is noise, what is left of it is smoothed over the whole picture in all channels
  /// that steer, with those of ChannelRole::feature as guides; see smooth_noise().
  bool smooth_noise = true;
  /// How far a fit rings beside an edge, as a share of the range of the whole block's means. A
  /// pixel that is off by at most as much from what its own samples and those of two neighbours
  /// show alike is held at that; and in any case where all eight neighbours show the same. In the
  /// same blocks as `slack`, unless that is infinite. Finite and >= 0; 0: no pixel is held.
  double ringing = 0.025;
  /// Where no sample of a channel is negative, in the whole picture, no pixel is: what is added to
  /// pixels below zero is taken from the others of their block in proportion. Signed functions stay
  /// as they are.
  bool keep_positive = true;

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate() const;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/finish_settings.inl"
#endif
