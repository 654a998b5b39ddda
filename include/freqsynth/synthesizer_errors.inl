// SPDX-License-Identifier: MIT
// The expected errors of a synthesis.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "freqsynth/image/error_image.h"

namespace freqsynth {

FREQSYNTH_INLINE std::vector<float> Synthesizer::error_image(const FinishSettings& settings) const {
  settings.validate();
  if (const TreeSynthesis* tree = implementation_->tree()) return tree->error_image(settings);
  const std::vector<float> all = implementation_->with_blocks([&](const auto& engine) {
    return engine.with_snapshot([&](const BlockGrid& grid, const auto& blocks, bool noisy) {
      return freqsynth::error_image(grid, blocks, detail::settings_for(settings, noisy));
    });
  });
  return implementation_->shown(all, detail::image_channels(this->settings()));
}

inline double Synthesizer::Implementation::predicted_rmse(const BlockGrid& sampled,
                                                          const BlockSnapshot<R>& blocks,
                                                          const FinishSettings& finish) const {
  const std::vector<double> squares = expected_squared_errors(sampled, blocks, finish, shown());
  std::vector<float> weights = detail::channel_weights(settings);
  const bool none = std::none_of(weights.begin(), weights.end(), [](float one) { return one > 0; });
  if (none) weights.assign(weights.size(), 1 / static_cast<float>(weights.size()));
  double square = 0;
  for (std::size_t c = 0; c < squares.size(); ++c) {
    if (weights[c] > 0) square += double{weights[c]} * squares[c];
  }
  return std::sqrt(square);
}

FREQSYNTH_INLINE double Synthesizer::predicted_rmse(const FinishSettings& settings) const {
  settings.validate();
  if (const TreeSynthesis* tree = implementation_->tree()) return tree->predicted_rmse(settings);
  return implementation_->with_blocks([&](const auto& engine) {
    return engine.with_snapshot([&](const BlockGrid& grid, const auto& blocks, bool noisy) {
      return implementation_->predicted_rmse(grid, blocks, detail::settings_for(settings, noisy));
    });
  });
}

}  // namespace freqsynth
