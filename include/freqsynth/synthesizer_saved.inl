// SPDX-License-Identifier: MIT
// How an engine is saved and loaded.
#pragma once

#include <bit>
#include <memory>
#include <type_traits>

#include "freqsynth/basis/archive.h"

namespace freqsynth {
namespace detail {

/// What engines of different refiners save are different things.
inline const ArchiveKind& kind_of(const SynthesisSettings& settings) {
  return settings.refiner == RefinerKind::kriging ? tree_synthesis_kind : synthesis_kind;
}

/// A number of the settings; loading makes sure that it is the same.
template <class Archive, Number T>
void same_setting(Archive& archive, const std::string& name, T value) {
  T saved = value;
  archive.number(saved);
  if (std::bit_cast<BitsOf<T>>(saved) == std::bit_cast<BitsOf<T>>(value)) return;
  if constexpr (Archive::loading) {
    const auto text = [](T number) { return to_text(static_cast<double>(number)); };
    archive.fail("is of other settings: " + name + " was " + text(saved) + ", and is " +
                 text(value));
  }
}

/// A number of entries.
template <class Archive>
void same_count(Archive& archive, const std::string& name, std::size_t count) {
  same_setting(archive, "the number of " + name, std::uint64_t{count});
}

template <class Archive>
void same_priority(Archive& archive, const PrioritySettings& priority) {
  same_setting(archive, "priority.weight", priority.weight);
  same_setting(archive, "priority.uncertainty", priority.uncertainty);
  same_setting(archive, "priority.decay", priority.decay);
  same_setting(archive, "priority.measure", priority.measure);
  same_setting(archive, "priority.neighbours", priority.neighbours);
  same_setting(archive, "priority.image", priority.image);
  same_setting(archive, "priority.exploration", priority.exploration);
  same_setting(archive, "priority.steer", priority.steer);
  same_setting(archive, "priority.exposure", priority.exposure);
}

/// All settings that results depend on.
template <class Archive>
void same_settings(Archive& archive, const SynthesisSettings& settings) {
  same_setting(archive, "width", std::uint64_t{settings.width});
  same_setting(archive, "height", std::uint64_t{settings.height});
  same_setting(archive, "channels", std::uint64_t{settings.channels});
  same_setting(archive, "noise", settings.noise);
  same_setting(archive, "seed", settings.seed);
  const InverseListSettings& list =
      settings.shared_list ? settings.shared_list->settings() : settings.list;
  same_setting(archive, "list.samples_per_term", list.samples_per_term);
  same_setting(archive, "list.max_terms", std::uint64_t{list.max_terms});
  same_setting(archive, "list.seed", list.seed);
  same_setting(archive, "list.positions", list.positions);
  same_priority(archive, settings.priority);
  same_setting(archive, "wave", std::uint64_t{settings.wave});
  same_setting(archive, "max_samples_per_block", std::uint64_t{settings.max_samples_per_block});
  same_setting(archive, "least_samples_per_block", std::uint64_t{settings.least_samples_per_block});
  std::vector<ChannelSettings> channels = settings.channel_settings;
  if (channels.empty()) channels.resize(settings.channels);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::string name = "channel_settings[" + std::to_string(c) + "]";
    same_setting(archive, name + ".role", channels[c].role);
    same_setting(archive, name + ".weight", channels[c].weight);
  }
  same_count(archive, "importance", settings.importance.size());
  for (std::size_t b = 0; b < settings.importance.size(); ++b) {
    same_setting(archive, "importance", settings.importance[b]);
  }
  same_setting(archive, "window.x", std::uint64_t{settings.window.x});
  same_setting(archive, "window.y", std::uint64_t{settings.window.y});
  same_setting(archive, "window.width", std::uint64_t{settings.window.width});
  same_setting(archive, "window.height", std::uint64_t{settings.window.height});
  const QuantizationTarget target = settings.quantization.value_or(QuantizationTarget());
  same_setting(archive, "quantization", std::uint64_t{settings.quantization.has_value()});
  same_count(archive, "quantization.steps", target.steps.size());
  for (const auto& steps : target.steps) {
    for (const float step : steps) same_setting(archive, "one of quantization.steps", step);
  }
  same_setting(archive, "quantization.tolerance", target.tolerance);
  same_setting(archive, "quantization.most_samples", std::uint64_t{target.most_samples});
}

template <class Archive, class Engine>
void archive_synthesis(Archive& archive, const SynthesisSettings& settings, Engine& engine) {
  archive.section("SETT", [&] { same_settings(archive, settings); });
  if constexpr (Archive::loading) {
    engine.load(archive);
  } else {
    engine.save(archive);
  }
  archive.finish();
}

}  // namespace detail

FREQSYNTH_INLINE Synthesizer::Synthesizer(SynthesisSettings settings, ByteSource saved) {
  auto implementation = std::make_unique<Implementation>(std::move(settings));
  detail::StateReader reader(saved, detail::kind_of(implementation->settings));
  implementation->with_engine(
      [&](auto& engine) { detail::archive_synthesis(reader, implementation->settings, engine); });
  implementation_ = implementation.release();
}

FREQSYNTH_INLINE void Synthesizer::save(ByteSink sink) const {
  detail::StateWriter writer(sink, detail::kind_of(implementation_->settings));
  implementation_->with_engine([&](const auto& engine) {
    detail::archive_synthesis(writer, implementation_->settings, engine);
  });
}

FREQSYNTH_INLINE std::vector<std::byte> Synthesizer::save() const {
  std::vector<std::byte> bytes;
  save([&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  return bytes;
}

}  // namespace freqsynth
