// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/engine.h"
#include "freqsynth/engine/sampling_loop.inl"
#include "freqsynth/engine/steering.h"
#include "freqsynth/image/block_images.h"
#include "freqsynth/jpeg/quantizer_measure.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/synthesizer.h"
#include "freqsynth/synthesizer_settings.inl"
#include "freqsynth/synthesizer_tree.inl"

namespace freqsynth {

struct Synthesizer::Implementation {
  using R = LeastSquaresRefiner;
  using Engines = std::variant<std::monostate, Engine<R, ResidualMeasure>, Engine<R, ChangeMeasure>,
                               Engine<R, QuantizerMeasure>, TreeSynthesis>;

  explicit Implementation(SynthesisSettings wanted)
      : grid(detail::sampled_grid(wanted)),
        settings(detail::validated(std::move(wanted), grid.whole().size())) {
    const std::size_t blocks = grid.size();
    const std::size_t most = settings.max_samples_per_block;
    if (settings.refiner == RefinerKind::kriging) {
      engines.emplace<TreeSynthesis>(settings);
    } else if (settings.quantization) {
      build(QuantizerMeasure(*settings.quantization, settings.priority,
                             settings.noise == Noise::present, blocks, most));
    } else if (settings.priority.measure == PriorityMeasure::change) {
      build(ChangeMeasure(settings.priority, blocks, most, detail::steering_of(settings, blocks)));
    } else {
      build(
          ResidualMeasure(settings.priority, blocks, most, detail::steering_of(settings, blocks)));
    }
  }

  /// See Synthesizer::predicted_rmse().
  [[nodiscard]] double predicted_rmse(const BlockGrid& sampled, const BlockSnapshot<R>& blocks,
                                      const FinishSettings& finish) const;

  /// The synthesis by a tree, if it is one.
  [[nodiscard]] TreeSynthesis* tree() { return std::get_if<TreeSynthesis>(&engines); }
  [[nodiscard]] const TreeSynthesis* tree() const { return std::get_if<TreeSynthesis>(&engines); }

  /// Calls use(engine).
  template <class Use>
  auto with_engine(Use&& use) {
    if (TreeSynthesis* one = tree()) return use(one->engine);
    return visit(engines, use);
  }
  template <class Use>
  auto with_engine(Use&& use) const {
    if (const TreeSynthesis* one = tree()) return use(one->engine);
    return visit(engines, use);
  }
  /// The same of an engine of blocks.
  template <class Use>
  auto with_blocks(Use&& use) const {
    return visit(engines, use);
  }

  /// What is shown, in pixels of what is sampled.
  [[nodiscard]] PixelWindow shown() const {
    PixelWindow shown = grid.covered();
    if (grid.is_part()) shown = grid.whole().part(settings.window, 0).covered();
    shown.x -= grid.covered().x;
    shown.y -= grid.covered().y;
    return shown;
  }
  /// An image of all that is sampled as it is shown.
  [[nodiscard]] FrequencyImage shown(FrequencyImage image) const {
    return grid.is_part() ? image.part(shown()) : std::move(image);
  }
  /// The same of values of pixels, `channels` of each.
  [[nodiscard]] std::vector<float> shown(const std::vector<float>& all,
                                         std::size_t channels) const {
    const PixelWindow part = shown();
    std::vector<float> values;
    values.reserve(part.width * part.height * channels);
    for (std::size_t y = 0; y < part.height; ++y) {
      const std::size_t first = ((part.y + y) * grid.width + part.x) * channels;
      const auto row = all.begin() + static_cast<std::ptrdiff_t>(first);
      values.insert(values.end(), row, row + static_cast<std::ptrdiff_t>(part.width * channels));
    }
    return values;
  }
  /// Calls use(grid, snapshot, settings, features): settings that say whether there is noise.
  template <class Use>
  auto with_snapshot(const FinishSettings& finish, Use&& use) const {
    const std::vector<std::size_t> fitted = detail::channels_of(settings, ChannelRole::feature);
    const bool any = !detail::channels_of(settings, ChannelRole::mean_feature).empty();
    std::optional<PixelStore> means;
    return with_blocks([&](const auto& engine) {
      return engine.with_snapshot(
          [&](const BlockGrid& blocks_grid, const auto& blocks, bool noisy) {
            const SmoothingFeatures features{fitted, means ? &*means : nullptr};
            return use(blocks_grid, blocks, detail::settings_for(finish, noisy), features);
          },
          any ? &means : nullptr);
    });
  }

  BlockGrid grid;
  SynthesisSettings settings;
  Engines engines;

 private:
  template <class M>
  void build(M measure) {
    BlockStore<R> blocks(R(settings.shared_list, detail::image_channels(settings),
                           detail::channel_weights(settings)),
                         grid.size(), settings.max_samples_per_block);
    auto& engine = engines.emplace<Engine<R, M>>(
        grid, std::move(blocks), std::move(measure), detail::factors_of(grid, settings.importance),
        settings.wave, settings.priority.exploration, settings.seed, settings.noise,
        detail::roles_apart(settings), settings.least_samples_per_block);
    engine.use_packets(settings.packet);
    engine.use_predictor(
        [](const void* self, const BlockGrid& sampled, const BlockSnapshot<R>& now, bool noisy) {
          return static_cast<const Implementation*>(self)->predicted_rmse(
              sampled, now, detail::settings_for({}, noisy));
        },
        this);
  }

  template <class Variant, class Use>
  static auto visit(Variant& engines, Use& use) {
    if (auto* engine = std::get_if<Engine<R, ResidualMeasure>>(&engines)) return use(*engine);
    if (auto* engine = std::get_if<Engine<R, ChangeMeasure>>(&engines)) return use(*engine);
    return use(*std::get_if<Engine<R, QuantizerMeasure>>(&engines));
  }
};

FREQSYNTH_INLINE Synthesizer::Synthesizer(SynthesisSettings settings)
    : implementation_(new Implementation(std::move(settings))) {}

FREQSYNTH_INLINE Synthesizer::~Synthesizer() { delete implementation_; }

FREQSYNTH_INLINE void Synthesizer::set_stop(const StopRule& stop) {
  implementation_->with_engine([&](auto& engine) { engine.set_stop(stop); });
}

FREQSYNTH_INLINE std::size_t Synthesizer::request(std::span<Request> out, Wait wait) {
  return implementation_->with_engine([&](auto& engine) { return engine.request(out, wait); });
}

FREQSYNTH_INLINE std::size_t Synthesizer::wave_size() const {
  return implementation_->with_engine([](const auto& engine) { return engine.wave_size(); });
}

FREQSYNTH_INLINE void Synthesizer::deliver(std::span<const Request> requests,
                                           std::span<const float> values, std::size_t stride) {
  implementation_->with_engine([&](auto& engine) { engine.deliver(requests, values, stride); });
}

FREQSYNTH_INLINE void Synthesizer::give_back(std::span<const Request> requests) {
  implementation_->with_engine([&](auto& engine) { engine.give_back(requests); });
}

FREQSYNTH_INLINE void Synthesizer::abandon(std::span<const Request> requests) {
  implementation_->with_engine([&](auto& engine) { engine.abandon(requests); });
}

FREQSYNTH_INLINE void Synthesizer::cancel() {
  implementation_->with_engine([](auto& engine) { engine.cancel(); });
}

FREQSYNTH_INLINE Progress Synthesizer::progress() const {
  return implementation_->with_engine([](const auto& engine) { return engine.progress(); });
}

FREQSYNTH_INLINE std::optional<StopReason> Synthesizer::stopped() {
  return implementation_->with_engine([](auto& engine) { return engine.stopped(); });
}

FREQSYNTH_INLINE RunReport Synthesizer::run_erased(const detail::SamplerRef& sampler,
                                                   const StopRule& stop,
                                                   const detail::ExecutorRef& executor,
                                                   const detail::ProgressRef& progress,
                                                   std::size_t batch) {
  return implementation_->with_engine([&](auto& engine) {
    return detail::run_loop(engine, channels(), sampler, stop, executor, progress, batch);
  });
}

FREQSYNTH_INLINE FrequencyImage Synthesizer::image_on(const detail::ExecutorRef& executor) const {
  if (const TreeSynthesis* tree = implementation_->tree()) return tree->image(executor);
  return implementation_->shown(implementation_->with_blocks([&](const auto& engine) {
    return engine.with_snapshot([&](const BlockGrid& grid, const auto& blocks, bool) {
      return fit_image(grid, blocks, executor);
    });
  }));
}

FREQSYNTH_INLINE FrequencyImage Synthesizer::finished_image_on(
    const FinishSettings& settings, const detail::ExecutorRef& executor) const {
  settings.validate();
  if (const TreeSynthesis* tree = implementation_->tree())
    return tree->finished_image(settings, executor);
  return implementation_->shown(implementation_->with_snapshot(
      settings, [&](const BlockGrid& grid, const auto& blocks, const FinishSettings& known,
                    const SmoothingFeatures& features) {
        const SharedInverseList& list = implementation_->settings.shared_list;
        return freqsynth::finished_image(grid, blocks, list, known, features, executor);
      }));
}

FREQSYNTH_INLINE void Synthesizer::finish_on(const PixelView& out, const FinishSettings& settings,
                                             const detail::ExecutorRef& executor) const {
  settings.validate();
  if (const TreeSynthesis* tree = implementation_->tree()) {
    return reconstruct(tree->finished_image(settings, executor), {}, out, executor);
  }
  implementation_->with_snapshot(settings, [&](const BlockGrid& grid, const auto& blocks,
                                               const FinishSettings& known,
                                               const SmoothingFeatures& features) {
    const SharedInverseList& list = implementation_->settings.shared_list;
    freqsynth::finish(grid, blocks, list, known, features, implementation_->shown(), out, executor);
  });
}

FREQSYNTH_INLINE bool Synthesizer::noisy() const {
  return implementation_->with_engine([](const auto& engine) { return engine.noisy(); });
}

FREQSYNTH_INLINE std::vector<float> Synthesizer::channel_pixels(std::size_t channel) const {
  const std::size_t first = detail::image_channels(settings());
  if (channel < first || channel >= settings().channels) {
    detail::refuse("channel is " + std::to_string(channel) + ", not one without coefficients");
  }
  return implementation_->shown(implementation_->with_engine([&](const auto& engine) {
    return engine.channel_pixels(channel - first);
  }),
                                1);
}

FREQSYNTH_INLINE PixelWindow Synthesizer::window() const {
  PixelWindow window = implementation_->shown();
  window.x += implementation_->grid.covered().x;
  window.y += implementation_->grid.covered().y;
  return window;
}

FREQSYNTH_INLINE void Synthesizer::set_importance(std::span<const float> importance) {
  const BlockGrid& grid = implementation_->grid;
  detail::check_importance(importance, grid.whole().size());
  std::vector<float> factors = implementation_->tree() != nullptr
                                   ? std::vector<float>(importance.begin(), importance.end())
                                   : detail::factors_of(grid, importance);
  implementation_->with_engine([&](auto& engine) { engine.set_factors(std::move(factors)); });
}

FREQSYNTH_INLINE const SynthesisSettings& Synthesizer::settings() const {
  return implementation_->settings;
}

FREQSYNTH_INLINE SynthesisStats Synthesizer::stats() const {
  return implementation_->with_engine([](const auto& engine) { return engine.stats(); });
}

FREQSYNTH_INLINE std::vector<BadSample> Synthesizer::bad_samples() const {
  return implementation_->with_engine([](const auto& engine) { return engine.bad_samples(); });
}

}  // namespace freqsynth

#include "freqsynth/synthesizer_errors.inl"
#include "freqsynth/synthesizer_saved.inl"
