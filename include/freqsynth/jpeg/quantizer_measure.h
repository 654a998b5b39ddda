// SPDX-License-Identifier: MIT
/// \file
/// How much a block deserves the next sample when the synthesis ends in a quantiser (paper,
/// sections 1, 2 and 6): by what its errors may change after quantisation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/jpeg/quantization_target.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// A block that meets the target has priority 0.
class QuantizerMeasure {
 public:
  /// \param target  valid for the image's channels
  /// \param noisy   the sampler returns Monte Carlo estimates
  QuantizerMeasure(QuantizationTarget target, const PrioritySettings& settings, bool noisy,
                   std::size_t blocks, std::size_t most_samples)
      : target_(std::move(target)),
        metric_(settings, most_samples),
        neighbours_(static_cast<float>(settings.neighbours)),
        noisy_(noisy),
        book_(blocks),
        steps_(target_.steps) {
    for (std::size_t c = 0; c < steps_.size(); ++c) use_unit(c, 0);
  }

  /// See BlockMeasure.
  template <Refiner R>
  void use_units(const BlockView<R>& view, float factor) {
    book_.rescale(factor);
    for (std::size_t c = 0; c < steps_.size(); ++c) use_unit(c, view.blocks.exponent(c));
  }

  /// See BlockMeasure.
  template <Refiner R>
  bool notice_noise(const BlockView<R>&) {
    noisy_ = true;
    return true;
  }

  /// See BlockMeasure.
  template <Refiner R>
  void absorbed(const BlockView<R>& view, std::uint32_t block, std::span<const float>) {
    book_.note(block, plausible_residual(view, block));
  }
  /// See BlockMeasure.
  [[nodiscard]] static bool apart() { return true; }
  /// See BlockMeasure.
  template <Refiner R>
  double absorbed_apart(const BlockView<R>& view, std::uint32_t block, std::span<const float>) {
    return book_.exchange(block, plausible_residual(view, block));
  }
  /// See BlockMeasure.
  void add(double change) { book_.add(change); }

  /// The error falls with the number of samples; so it is worth error / samples to take one more.
  template <Refiner R>
  [[nodiscard]] float priority(const BlockView<R>& view, std::uint32_t block, float factor) const {
    const std::uint32_t samples = view.blocks.samples(block);
    if (per_whole_block(view, block) >= target_.most_samples) return 0;
    const float error = std::min(error_of(view, block), most_priority);
    std::size_t steering = 0;
    for (const float weight : view.blocks.refiner().weights()) steering += weight > 0 ? 1 : 0;
    const auto allowed =
        static_cast<float>(std::min(target_.allowed_error(steering), double{most_priority}));
    if (error <= allowed && samples >= QuantizationTarget::least_samples) return 0;
    return factor * std::max(error, allowed) / static_cast<float>(samples);
  }

  /// See BlockMeasure.
  [[nodiscard]] bool has_news(std::uint32_t block) { return book_.has_news(block); }
  /// Of the others only whether they still meet the target is of interest.
  [[nodiscard]] static bool cares(float priority) { return priority == 0; }
  /// See BlockMeasure.
  [[nodiscard]] static bool in_units() { return true; }

 private:
  friend struct StateArchive;

  /// Samples of a block, or as many as one of 8 x 8 pixels has with the same number per pixel.
  template <Refiner R>
  [[nodiscard]] static std::size_t per_whole_block(const BlockView<R>& view, std::uint32_t block) {
    const std::size_t pixels = view.grid.block_width(block) * view.grid.block_height(block);
    return view.blocks.samples(block) * max_terms / pixels;
  }

  void use_unit(std::size_t channel, int exponent) {
    for (std::size_t i = 0; i < max_terms; ++i) {
      // Smaller ones have squares that no float holds, and are as fine as none.
      const double step = std::ldexp(double{target_.steps[channel][i]}, -exponent);
      steps_[channel][i] = static_cast<float>(std::clamp(step, 1e-15, 1e38));
    }
  }

  /// Expected squared error after quantisation, in squared steps.
  template <Refiner R>
  [[nodiscard]] float error_of(const BlockView<R>& view, std::uint32_t block) const {
    const std::uint32_t samples = view.blocks.samples(block);
    float error = 0;
    std::array<float, max_terms> coefficients;
    for (std::size_t c = 0; c < target_.steps.size(); ++c) {
      if (view.blocks.refiner().weights()[c] == 0) continue;
      float residual = book_.pooled(
          view, block, [&](std::uint32_t b) { return plausible_residual(view, b, c); }, neighbours_,
          0);
      if (!noisy_) residual *= evenness(per_whole_block(view, block));
      residual += metric_.uncertainty(samples, view.signal.variance(c));
      view.blocks.coefficients(block, c, coefficients);
      error += quantized_error(steps_[c], coefficients, view.blocks.refiner().variances(samples),
                               residual);
    }
    return error;
  }

  QuantizationTarget target_;
  PriorityMetric metric_;
  float neighbours_;
  bool noisy_;
  ResidualBook book_;
  std::vector<std::array<float, max_terms>> steps_;  // in the units of the channels
};

}  // namespace freqsynth
