// SPDX-License-Identifier: MIT
// A synthesis by a tree of nodes: RefinerKind::kriging.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/engine/tree_engine.h"
#include "freqsynth/engine/tree_settings.h"
#include "freqsynth/image/tree_images.h"
#include "freqsynth/synthesis_settings.h"
#include "freqsynth/synthesizer_settings.inl"

namespace freqsynth {
namespace detail {

/// Refuses a setting that a tree has no use for, unless it is as it is by default.
template <class T>
void require_unused(const char* name, T value, T usual) {
  require(value == usual, name, static_cast<double>(value),
          (to_text(static_cast<double>(usual)) + ", with RefinerKind::kriging").c_str());
}

/// The settings of a tree. \throws std::invalid_argument naming one that it has no use for.
inline TreeSettings tree_settings(const SynthesisSettings& settings) {
  const SynthesisSettings usual;
  require(settings.height < std::size_t{1} << 20, "height", static_cast<double>(settings.height),
          "below 2^20, with RefinerKind::kriging");
  for (const std::size_t one :
       {settings.window.x, settings.window.y, settings.window.width, settings.window.height}) {
    require_unused("window", one, std::size_t{0});
  }
  require_unused("quantization", settings.quantization.has_value(), false);
  require_unused("shared_list", bool{settings.shared_list}, false);
  require_unused("max_samples_per_block", settings.max_samples_per_block,
                 usual.max_samples_per_block);
  require_unused("least_samples_per_block", settings.least_samples_per_block, std::size_t{0});
  require_unused("list.samples_per_term", settings.list.samples_per_term,
                 usual.list.samples_per_term);
  require_unused("list.max_terms", settings.list.max_terms, usual.list.max_terms);
  const PrioritySettings &priority = settings.priority, &other = usual.priority;
  require_unused("priority.weight", priority.weight, other.weight);
  require_unused("priority.uncertainty", priority.uncertainty, other.uncertainty);
  require_unused("priority.decay", priority.decay, other.decay);
  require_unused("priority.measure", priority.measure, other.measure);
  require_unused("priority.neighbours", priority.neighbours, other.neighbours);
  require_unused("priority.image", priority.image, other.image);
  require_unused("the number of channels of role feature",
                 channels_of(settings, ChannelRole::feature).size(), std::size_t{0});
  TreeSettings tree;
  tree.width = settings.width;
  tree.height = settings.height;
  tree.weights = channel_weights(settings);
  tree.seed = settings.list.seed;
  tree.noisy = settings.noise == Noise::present;
  if (settings.list.positions == SamplePositions::lattice) tree.perturbation = 0;
  tree.wave = settings.wave;
  tree.steer = priority.steer;
  tree.exposure = priority.exposure;
  tree.exploration = priority.exploration;
  return tree;
}

/// Root of the mean of expected squared errors over all pixels, and over channels by their weights.
inline double weighted_root(const std::vector<float>& squares, std::vector<float> weights) {
  const bool none = std::none_of(weights.begin(), weights.end(), [](float one) { return one > 0; });
  if (none) weights.assign(weights.size(), 1 / static_cast<float>(weights.size()));
  double sum = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const float weight = weights[i % weights.size()];
    if (weight > 0) sum += double{weight} * double{squares[i]};
  }
  const std::size_t pixels = squares.size() / weights.size();
  return pixels > 0 ? std::sqrt(sum / static_cast<double>(pixels)) : 0;
}

}  // namespace detail

/// An engine of a tree, and what makes its images.
struct TreeSynthesis {
  explicit TreeSynthesis(const SynthesisSettings& settings)
      : weights(detail::channel_weights(settings)),
        engine(detail::tree_settings(settings), settings.importance, settings.seed, settings.noise,
               detail::roles_apart(settings)),
        images(engine.positions()) {
    engine.use_packets(settings.packet);
    engine.use_predictor(
        [](const void* self, const NodeTree& tree, bool noisy) {
          const auto* own = static_cast<const TreeSynthesis*>(self);
          return detail::weighted_root(own->images.expected_squares(tree, noisy), own->weights);
        },
        this);
  }
  TreeSynthesis(const TreeSynthesis&) = delete;
  TreeSynthesis& operator=(const TreeSynthesis&) = delete;

  /// See Synthesizer::finished_image().
  [[nodiscard]] FrequencyImage finished_image(const FinishSettings& settings,
                                              const detail::ExecutorRef& executor) const {
    const auto [tree, noisy] = engine.snapshot();
    const FinishSettings known = detail::settings_for(settings, noisy);
    return images.image(tree, known.noise == Noise::present, known.keep_positive, executor);
  }
  /// See Synthesizer::image().
  [[nodiscard]] FrequencyImage image(const detail::ExecutorRef& executor) const {
    return rough_image(engine.snapshot().first, executor);
  }
  /// The squares of Synthesizer::error_image().
  [[nodiscard]] std::vector<float> expected_squares(const FinishSettings& settings) const {
    const auto [tree, noisy] = engine.snapshot();
    const FinishSettings known = detail::settings_for(settings, noisy);
    return images.expected_squares(tree, known.noise == Noise::present);
  }
  /// See Synthesizer::error_image().
  [[nodiscard]] std::vector<float> error_image(const FinishSettings& settings) const {
    std::vector<float> errors = expected_squares(settings);
    for (float& error : errors) error = std::sqrt(error);
    return errors;
  }
  /// See Synthesizer::predicted_rmse().
  [[nodiscard]] double predicted_rmse(const FinishSettings& settings) const {
    return detail::weighted_root(expected_squares(settings), weights);
  }

  std::vector<float> weights;  // of each channel
  TreeEngine engine;
  mutable TreeImages images;
};

}  // namespace freqsynth
