// SPDX-License-Identifier: MIT
#pragma once

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

namespace freqsynth {
namespace detail {

/// The channels of that role.
inline std::vector<std::size_t> channels_of(const SynthesisSettings& settings, ChannelRole role) {
  std::vector<std::size_t> channels;
  for (std::size_t c = 0; c < settings.channel_settings.size(); ++c) {
    if (settings.channel_settings[c].role == role) channels.push_back(c);
  }
  return channels;
}

/// Number of channels that have no coefficients: the last ones.
inline std::size_t nearest_channels(const SynthesisSettings& settings) {
  return channels_of(settings, ChannelRole::nearest).size();
}

inline void check_channels(const SynthesisSettings& settings) {
  const std::vector<ChannelSettings>& all = settings.channel_settings;
  if (all.empty()) return;
  if (all.size() != settings.channels) {
    refuse("channel_settings has " + std::to_string(all.size()) + " entries for " +
           std::to_string(settings.channels) + " channels");
  }
  const std::size_t first_nearest = all.size() - nearest_channels(settings);
  if (first_nearest == 0) {
    refuse("channel_settings has " + std::to_string(all.size()) +
           " channels of role nearest, not at least one other");
  }
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c].role > ChannelRole::nearest) {
      refuse("one of channel_settings' roles is " + std::to_string(static_cast<int>(all[c].role)) +
             ", not steer, passive, feature or nearest");
    }
    if (c < first_nearest && all[c].role == ChannelRole::nearest) {
      refuse("channel_settings has the role nearest for channel " + std::to_string(c) +
             ", not after all others");
    }
    const float weight = all[c].weight;
    require(all[c].role != ChannelRole::steer ||
                (is_finite(weight) && weight >= 1e-30f && weight <= 1e6f),
            "one of channel_settings' weights", weight, "in 1e-30..1e6");
  }
}

/// Weight of each channel that has coefficients: shares of 1, and 0 for those that do not steer.
inline std::vector<float> channel_weights(const SynthesisSettings& settings) {
  std::vector<ChannelSettings> all = settings.channel_settings;
  if (all.empty()) all.resize(settings.channels);
  all.resize(settings.channels - nearest_channels(settings));
  double sum = 0;
  for (ChannelSettings& one : all) {
    if (one.role != ChannelRole::steer) one.weight = 0;
    sum += double{one.weight};
  }
  std::vector<float> weights;
  for (const ChannelSettings& one : all) {
    weights.push_back(one.weight > 0 ? static_cast<float>(double{one.weight} / sum) : 0);
  }
  return weights;
}

/// \param blocks  of the whole picture
inline void check_importance(std::span<const float> importance, std::size_t blocks) {
  if (!importance.empty() && importance.size() != blocks) {
    refuse("importance has " + std::to_string(importance.size()) + " entries for " +
           std::to_string(blocks) + " blocks");
  }
  for (const float factor : importance) {
    // Smaller factors than that would make priorities nothing at all.
    const bool in_range = factor >= 1e-6f && factor <= 1e6f;
    require(is_finite(factor) && (factor == 0 || in_range), "one of importance", factor,
            "0 or in 1e-6..1e6");
  }
}

/// Settings that are in range, with a list.
/// \param blocks  of the whole picture
inline SynthesisSettings validated(SynthesisSettings settings, std::size_t blocks) {
  settings.priority.validate();
  if (settings.max_samples_per_block == 0 ||
      settings.max_samples_per_block > SampleSequence::max_size) {
    refuse("max_samples_per_block is " + std::to_string(settings.max_samples_per_block) +
           ", not in 1.." + std::to_string(SampleSequence::max_size));
  }
  if (settings.least_samples_per_block > settings.max_samples_per_block) {
    refuse("least_samples_per_block is " + std::to_string(settings.least_samples_per_block) +
           ", not in 0.." + std::to_string(settings.max_samples_per_block));
  }
  check_importance(settings.importance, blocks);
  check_channels(settings);
  if (settings.quantization) {
    settings.quantization->validate(settings.channels - nearest_channels(settings));
    require(settings.priority.steer == Steer::linear, "priority.steer",
            static_cast<double>(settings.priority.steer), "linear, with a quantization target");
  }
  if (!settings.shared_list) settings.shared_list = SharedInverseList(settings.list);
  return settings;
}

/// The blocks that are sampled for a part of a picture.
inline BlockGrid sampled_grid(const SynthesisSettings& settings) {
  // What shows in a block's finished pixels lies in it, in those around it, and around these.
  constexpr std::size_t margin = 2;
  const BlockGrid whole = BlockGrid::of(settings.width, settings.height, settings.channels);
  const PixelWindow& window = settings.window;
  if (window.x == 0 && window.y == 0 && window.width == 0 && window.height == 0) return whole;
  whole.check(window);
  return whole.part(window, margin);
}

/// Factor on the priority of each block: its importance times its area.
/// \param importance  of all blocks of the frame, or empty
inline std::vector<float> factors_of(const BlockGrid& grid, std::span<const float> importance) {
  std::vector<float> factors(grid.size());
  for (std::size_t b = 0; b < factors.size(); ++b) {
    factors[b] = grid.area(b);
    if (!importance.empty()) factors[b] *= importance[grid.in_frame(b)];
  }
  return factors;
}

/// With the host's weights of the channels.
inline Steering steering_of(const SynthesisSettings& settings, std::size_t blocks) {
  return {settings.priority, settings.noise == Noise::present, channel_weights(settings), blocks};
}

/// With what the engine knows of noise, unless the settings say otherwise.
inline FinishSettings settings_for(FinishSettings settings, bool noisy) {
  if (settings.noise == Noise::automatic) settings.noise = noisy ? Noise::present : Noise::none;
  return settings;
}

}  // namespace detail

struct Synthesizer::Implementation {
  using R = LeastSquaresRefiner;
  using Engines = std::variant<std::monostate, Engine<R, ResidualMeasure>, Engine<R, ChangeMeasure>,
                               Engine<R, QuantizerMeasure>>;

  explicit Implementation(SynthesisSettings wanted)
      : grid(detail::sampled_grid(wanted)),
        settings(detail::validated(std::move(wanted), grid.whole().size())) {
    const std::size_t blocks = grid.size();
    const std::size_t most = settings.max_samples_per_block;
    if (settings.quantization) {
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

  /// Calls use(engine).
  template <class Use>
  auto with_engine(Use&& use) {
    return visit(engines, use);
  }
  template <class Use>
  auto with_engine(Use&& use) const {
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
    const std::vector<std::size_t> features = detail::channels_of(settings, ChannelRole::feature);
    return with_engine([&](const auto& engine) {
      return engine.with_snapshot(
          [&](const BlockGrid& blocks_grid, const auto& blocks, bool noisy) {
            return use(blocks_grid, blocks, detail::settings_for(finish, noisy), features);
          });
    });
  }

  BlockGrid grid;
  SynthesisSettings settings;
  Engines engines;

 private:
  template <class M>
  void build(M measure) {
    const std::size_t nearest = detail::nearest_channels(settings);
    BlockStore<R> blocks(
        R(settings.shared_list, settings.channels - nearest, detail::channel_weights(settings)),
        grid.size(), settings.max_samples_per_block);
    auto& engine = engines.emplace<Engine<R, M>>(
        grid, std::move(blocks), std::move(measure), detail::factors_of(grid, settings.importance),
        settings.wave, settings.priority.exploration, settings.seed, settings.noise, nearest,
        settings.least_samples_per_block);
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
  return implementation_->shown(implementation_->with_engine([&](const auto& engine) {
    return engine.with_snapshot([&](const BlockGrid& grid, const auto& blocks, bool) {
      return fit_image(grid, blocks, executor);
    });
  }));
}

FREQSYNTH_INLINE FrequencyImage Synthesizer::finished_image_on(
    const FinishSettings& settings, const detail::ExecutorRef& executor) const {
  settings.validate();
  return implementation_->shown(implementation_->with_snapshot(
      settings, [&](const BlockGrid& grid, const auto& blocks, const FinishSettings& known,
                    std::span<const std::size_t> features) {
        const SharedInverseList& list = implementation_->settings.shared_list;
        return freqsynth::finished_image(grid, blocks, list, known, features, executor);
      }));
}

FREQSYNTH_INLINE void Synthesizer::finish_on(const PixelView& out, const FinishSettings& settings,
                                             const detail::ExecutorRef& executor) const {
  settings.validate();
  implementation_->with_snapshot(settings, [&](const BlockGrid& grid, const auto& blocks,
                                               const FinishSettings& known,
                                               std::span<const std::size_t> features) {
    const SharedInverseList& list = implementation_->settings.shared_list;
    freqsynth::finish(grid, blocks, list, known, features, implementation_->shown(), out, executor);
  });
}

FREQSYNTH_INLINE bool Synthesizer::noisy() const {
  return implementation_->with_engine([](const auto& engine) { return engine.noisy(); });
}

FREQSYNTH_INLINE std::vector<float> Synthesizer::nearest_pixels(std::size_t channel) const {
  const std::size_t all = settings().channels;
  const std::size_t first = all - detail::nearest_channels(settings());
  if (channel < first || channel >= all) {
    detail::refuse("channel is " + std::to_string(channel) + ", not one of role nearest");
  }
  return implementation_->shown(implementation_->with_engine([&](const auto& engine) {
    return engine.nearest_pixels(channel - first);
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
  std::vector<float> factors = detail::factors_of(grid, importance);
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
