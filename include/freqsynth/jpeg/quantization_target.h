// SPDX-License-Identifier: MIT
/// \file
/// The target of a synthesis that ends in a quantiser (paper, sections 1, 2 and 6): a block needs
/// samples while the errors of its coefficients can still change what the quantiser keeps.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Quantiser steps in the unit of the signal, and how much error beside that of the quantiser
/// itself is allowed. It is the priority and the stop rule of a synthesis in one.
struct QuantizationTarget {
  /// No block is done with fewer samples, a complete lattice of 5 x 5: that much of any image is
  /// looked at, whatever the first samples say.
  static constexpr std::size_t least_samples = 25;

  /// Per channel the step of each coefficient F in zig-zag order, at least 1e-37; infinity for one
  /// that is dropped. Those of channels that do not steer are not read.
  std::vector<std::array<float, max_terms>> steps;
  /// A block is done when its expected squared error, in squared steps and summed over all
  /// channels, is at most this share of what the quantiser itself does to a block of which it keeps
  /// all coefficients: 1/12 for each. Finite and > 0; at 1/4 sampling takes at most 1 dB from such
  /// a block.
  double tolerance = 0.25;

  /// A block is done after so many samples, 64 per pixel, whatever its expected error: where they
  /// do not suffice, as at edges that lie along rows of samples, more would not for long. A block
  /// of less than 8 x 8 pixels is done after so many less. At least 1.
  std::size_t most_samples = 4096;

  /// The most squared error of a block that is done, in squared steps, over so many channels.
  [[nodiscard]] double allowed_error(std::size_t channels) const {
    return tolerance * static_cast<double>(max_terms * channels) / 12;
  }

  /// \throws std::invalid_argument naming the field and the value when out of range.
  FREQSYNTH_API void validate(std::size_t channels) const;
};

/// Factor on the squared error that least squares expects of independent samples, for samples that
/// are spread evenly over a function without noise: the error at an edge falls with n^(-3/2)
/// instead of 1/n once there is more than a sample per pixel.
[[nodiscard]] FREQSYNTH_API float evenness(std::size_t samples);

/// Expected squared error of a channel of a block, in squared steps, over those coefficients whose
/// error may change the quantised value. A coefficient that is quantised to zero and stays there,
/// within two standard deviations, does not count: the quantiser removes its error.
/// \param steps         at least 1e-15: smaller ones have squares that no float holds
/// \param coefficients  F, zig-zag, as they will be quantised (but for the level shift of F(0,0))
/// \param variances     expected squared error of each per unit of `residual`
/// \param residual      variance of the residuals of the fit
[[nodiscard]] FREQSYNTH_API float quantized_error(const std::array<float, max_terms>& steps,
                                                  std::span<const float, max_terms> coefficients,
                                                  std::span<const float, max_terms> variances,
                                                  float residual);

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/quantization_target.inl"
#endif
